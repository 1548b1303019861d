// Multiscale roughness of a surface, and its increase by a mark.
#pragma once

#include "engine/mesh/mesh.h"

namespace triglyph {

// Returns the multiscale roughness, dimensionless, 0 for a flat surface. A face's bend is the mean
// of 1 - cos of the dihedral angles to its neighbours. A point's roughness is the mean times the
// variance of the bends of the faces within one ring, or within two rings, per unit of their area,
// whichever is greater. A face's roughness is the mean of its points', and the result is the sum
// over the faces, weighted by area. O(faces * faces in two rings).
// After Corsini, Gelasca, Ebrahimi, Barni, Watermarked 3-D mesh quality assessment. IEEE Trans.
// Multimedia 9(2) (2007). Where their text leaves a normalisation open, this is our choice, so
// values compare only with other values of triglyph.
[[nodiscard]] double roughness(const Mesh& mesh);

// Returns log((after - before) / before + 120) - log(120) for two roughnesses, with the paper's
// constant: 0 if they are equal, < 0 if the surface got smoother, infinite if only `before` is 0.
[[nodiscard]] double roughness_increase(double before, double after);

}  // namespace triglyph
