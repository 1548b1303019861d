// How rough a surface is, and how much rougher a mark made it.
#pragma once

#include "engine/mesh/mesh.h"

namespace triglyph {

// Multiscale roughness, dimensionless, 0 where flat. At a face, 1 - cos of the dihedral angles is
// averaged over its neighbours; at a point, mean times variance of that over the faces within one
// and within two rings, a unit of their area, whichever is greater; a face takes the mean of its
// points, and the whole is the sum over faces times their areas. O(faces * faces in two rings).
// In the manner of Corsini, Gelasca, Ebrahimi, Barni, Watermarked 3-D mesh quality assessment. IEEE
// Trans. Multimedia 9(2) (2007); where their text leaves a normalisation open this is ours, so
// compare values of triglyph with each other only.
[[nodiscard]] double roughness(const Mesh& mesh);

// log((after - before) / before + 120) - log(120) of the two roughnesses: 0 for none, and < 0 if
// the surface got smoother. 0 if `before` is 0 and `after` too, else infinite.
[[nodiscard]] double roughness_increase(double before, double after);

}  // namespace triglyph
