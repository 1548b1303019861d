// How far two surfaces are from each other, certified: every distance comes with a bound of its
// error. Embree prunes, double decides.
#pragma once

#include <span>

#include "engine/mesh/mesh.h"
#include "engine/metric/farthest_point.h"

namespace triglyph {

// All in model units.
struct HausdorffDistance {
  FarthestPoint forward;   // the first surface's farthest point from the second
  FarthestPoint backward;  // and the other way round

  [[nodiscard]] double symmetric() const {
    return forward.distance > backward.distance ? forward.distance : backward.distance;
  }
  // The true symmetric distance is at most symmetric() + error().
  [[nodiscard]] double error() const;
};

// A usual tolerance, as a share of the diagonal of the first mesh's box.
inline constexpr double kHausdorffTolerance = 1e-6;

// Between two positions of the same triangles, with an error of at most `tolerance` (model units,
// > 0) each way. Triangles that did not move count nothing; one that moved is no farther than its
// corners' moves. Precondition: equal sizes. O(m log t) for m triangles that moved.
[[nodiscard]] HausdorffDistance hausdorff_of_move(std::span<const Triangle> triangles,
                                                  std::span<const Vec3> before,
                                                  std::span<const Vec3> after, double tolerance);

// Between any two meshes; a point no triangle uses does not count. Throws Error Usage if either has
// no triangles. O((s + t) log (s + t)).
[[nodiscard]] HausdorffDistance hausdorff(const Mesh& first, const Mesh& second, double tolerance);

}  // namespace triglyph
