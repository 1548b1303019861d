// Closest-point queries on a set of triangles. Embree finds candidates in single precision,
// relative to the centre of the bounding box and with padded radii. Distances are computed and
// compared in double precision and ties go to the triangle of lowest index, so results depend
// neither on the number of threads nor on the instruction set.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "engine/geometry/triangle.h"
#include "engine/geometry/vec3.h"

namespace triglyph {

inline constexpr std::uint32_t kNoTriangle = 0xffffffff;

struct ClosestPoint {
  double distance = 0;                   // model units
  std::uint32_t triangle = kNoTriangle;  // index of the triangle; kNoTriangle: none within reach
  Vec3 point{0, 0, 0};
};

struct Plane {
  Vec3 point{0, 0, 0};
  Vec3 normal{0, 0, 0};  // any length; zero if the plane is undefined
};

class SpatialIndex {
 public:
  // Builds the index over `triangles`, whose corners index `positions`. Both must outlive the
  // index. O(t log t), parallel.
  SpatialIndex(std::span<const Vec3> positions, std::span<const Triangle> triangles);
  ~SpatialIndex();
  SpatialIndex(SpatialIndex&&) noexcept;

  // Returns the point of the triangles that is closest to `query`, if one lies within `reach`
  // (model units, inclusive; may be infinite). Safe to call from many threads. O(log t) on average.
  [[nodiscard]] ClosestPoint closest(const Vec3& query, double reach) const;

  // Returns the distance from `query` to a triangle, in model units.
  [[nodiscard]] double distance_to(const Vec3& query, std::uint32_t triangle) const;

  // Returns a side plane, through edge 0, 1 or 2, of the triangle's prism: the points whose
  // perpendicular foot on the triangle's plane lies inside the triangle. The unit normal points out
  // of the prism.
  [[nodiscard]] Plane prism_side(std::uint32_t triangle, std::size_t edge) const;

  // Returns the triangles within `radius` (model units, inclusive, finite) of `centre`, ascending,
  // or nothing if there are more than `most`. Safe to call from many threads. O(log t + triangles
  // found).
  [[nodiscard]] std::optional<std::vector<std::uint32_t>> triangles_in_ball(const Vec3& centre,
                                                                            double radius,
                                                                            std::size_t most) const;

 private:
  struct Scene;
  std::unique_ptr<Scene> scene_;
};

// Returns the point of triangle a, b, c that is closest to `query`. The triangle may be degenerate.
// Ericson, Real-Time Collision Detection (2005), section 5.1.5.
[[nodiscard]] Vec3 closest_on_triangle(const Vec3& query, const Vec3& a, const Vec3& b,
                                       const Vec3& c);

}  // namespace triglyph
