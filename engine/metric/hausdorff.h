// The Hausdorff distance of two surfaces with a certified error. Embree prunes in single precision;
// distances are computed and compared in double precision.
#pragma once

#include <span>

#include "engine/mesh/mesh.h"
#include "engine/metric/farthest_point.h"

namespace triglyph {

// All in model units.
struct HausdorffDistance {
  FarthestPoint forward;   // the point of the first surface that is farthest from the second
  FarthestPoint backward;  // the point of the second surface that is farthest from the first

  [[nodiscard]] double symmetric() const {
    return forward.distance > backward.distance ? forward.distance : backward.distance;
  }
  // Returns the error: the true symmetric distance lies in [symmetric(), symmetric() + error()].
  [[nodiscard]] double error() const;
};

// The default tolerance, as a share of the diagonal of the first mesh's bounding box: far below any
// distance that a mark makes.
inline constexpr double kHausdorffTolerance = 1e-6;

// Returns the distance between two positions of the same triangles, with an error of at most
// `tolerance` (model units, > 0) in each direction. Only triangles that moved are searched; none of
// them is farther away than its corners moved. Precondition: equal sizes. O(m log t) for m
// triangles that moved.
[[nodiscard]] HausdorffDistance hausdorff_of_move(std::span<const Triangle> triangles,
                                                  std::span<const Vec3> before,
                                                  std::span<const Vec3> after, double tolerance);

// Returns the distance between any two meshes, likewise. Points without triangles do not count.
// Throws Error Usage if either mesh has no triangles. O((s + t) log (s + t)).
[[nodiscard]] HausdorffDistance hausdorff(const Mesh& first, const Mesh& second, double tolerance);

}  // namespace triglyph
