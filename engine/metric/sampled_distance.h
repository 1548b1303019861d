// Distances between surfaces from samples: mean and root mean square, and the conventions of the
// field's two tools, so that figures compare with published ones. Distances of samples are exact.
// note: the maximum of samples is a lower bound; engine/metric/hausdorff.h has the certified one.
#pragma once

#include <cstdint>

#include "engine/mesh/mesh.h"

namespace triglyph {

// From one surface to another, model units.
struct DistanceStatistics {
  double max = 0;
  double mean = 0;
  double rms = 0;
  std::uint64_t samples = 0;
};

struct TwoWayStatistics {
  DistanceStatistics forward;   // samples of the first surface
  DistanceStatistics backward;  // and of the second
};

// As Metro samples by default: 10 samples a face of the mesh that has more, on the vertices, then
// equally spaced on the edges, then on the faces by similar triangles, with Metro's budget in which
// the vertices count twice; max, mean and RMS are over the samples.
// note: Metro prints distances also relative to the diagonal of both meshes' box, widened by 2 % on
// every side, which is 1.07 diagonals of a cube; these are plain model units.
// Throws Error Usage if a mesh has no faces. O(samples log t).
// Cignoni, Rocchini, Scopigno, Metro: measuring error on simplified surfaces. CGF 17(2) (1998).
[[nodiscard]] TwoWayStatistics metro(const Mesh& first, const Mesh& second);

// As MESH does it: each face carries a regular grid of samples, `step` apart at most (model units,
// > 0), between which the distance is interpolated linearly and integrated over the surface.
// MRMS is the greater RMS of the two directions. Throws Error Usage if a mesh has no faces or
// area. O(samples log t).
// Aspert, Santa-Cruz, Ebrahimi, MESH: measuring errors between surfaces using the Hausdorff
// distance. ICME (2002).
[[nodiscard]] TwoWayStatistics mesh_distance(const Mesh& first, const Mesh& second, double step);

// MESH's sampling step, as a share of the diagonal of the larger mesh's box.
inline constexpr double kMeshStep = 0.005;

}  // namespace triglyph
