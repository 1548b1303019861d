// Sampled distances between surfaces: maximum, mean and root mean square, under the conventions of
// the field's two tools, Metro and MESH, so that values compare with published ones. The distance
// of each sample is exact.
// note: the maximum over samples is a lower bound; engine/metric/hausdorff.h has the certified
// maximum.
#pragma once

#include <cstdint>

#include "engine/mesh/mesh.h"

namespace triglyph {

// Distances from one surface to another, in model units.
struct DistanceStatistics {
  double max = 0;
  double mean = 0;
  double rms = 0;
  std::uint64_t samples = 0;
};

struct TwoWayStatistics {
  DistanceStatistics forward;   // samples of the first surface
  DistanceStatistics backward;  // samples of the second surface
};

// Returns distances sampled as Metro samples by default: 10 samples per face of the mesh with more
// faces, first the vertices, then equally spaced on edges, then on faces by similar triangles, with
// Metro's budget, in which vertices count twice. Maximum, mean and RMS are over the samples. Throws
// Error Usage if a mesh has no faces. O(samples log t).
// note: Metro also prints distances relative to the diagonal of the box of both meshes, widened by
// 2 % on every side, which is 1.07 diagonals of a cube. These are plain model units.
// Cignoni, Rocchini, Scopigno, Metro: measuring error on simplified surfaces. CGF 17(2) (1998).
[[nodiscard]] TwoWayStatistics metro(const Mesh& first, const Mesh& second);

// Returns distances sampled as MESH samples: on a regular grid on each face, with samples at most
// `step` apart (model units, > 0), between which the distance is interpolated linearly and
// integrated over the surface. MRMS is the greater RMS of the two directions. Throws Error Usage if
// a mesh has no faces or no area. O(samples log t).
// Aspert, Santa-Cruz, Ebrahimi, MESH: measuring errors between surfaces using the Hausdorff
// distance. ICME (2002).
[[nodiscard]] TwoWayStatistics mesh_distance(const Mesh& first, const Mesh& second, double step);

// MESH's default sampling step, as a share of the diagonal of the larger mesh's bounding box.
inline constexpr double kMeshStep = 0.005;

}  // namespace triglyph
