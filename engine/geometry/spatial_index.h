// Closest points on a set of triangles. Embree finds the candidates in single precision, relative
// to the box's centre and with padded radii; distances are computed and compared in double, and of
// equal ones the lowest triangle wins, so an answer depends neither on threads nor on the
// instruction set.
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
  std::uint32_t triangle = kNoTriangle;  // index in the span given; kNoTriangle: none in reach
  Vec3 point{0, 0, 0};
};

struct Plane {
  Vec3 point{0, 0, 0};
  Vec3 normal{0, 0, 0};  // of any length; zero where the plane is undefined
};

class SpatialIndex {
 public:
  // Keeps views of both; they must outlive the index. O(t log t), parallel.
  SpatialIndex(std::span<const Vec3> positions, std::span<const Triangle> triangles);
  ~SpatialIndex();
  SpatialIndex(SpatialIndex&&) noexcept;

  // The nearest point on any triangle within `reach` of `query` (inclusive; infinity: anywhere).
  // Safe to call from many threads. O(log t) typically.
  [[nodiscard]] ClosestPoint closest(const Vec3& query, double reach) const;

  // Of one of the triangles from `query`. O(1).
  [[nodiscard]] double distance_to(const Vec3& query, std::uint32_t triangle) const;

  // The side plane over edge 0, 1 or 2 of the prism of points whose foot on the triangle's plane
  // lies inside the triangle. The normal, of unit length, points outwards.
  [[nodiscard]] Plane prism_side(std::uint32_t triangle, std::size_t edge) const;

  // All triangles that come as near as `radius` (inclusive, finite) to `centre`, ascending; nothing
  // if there are more than `most`. Safe to call from many threads. O(log t + triangles found).
  [[nodiscard]] std::optional<std::vector<std::uint32_t>> triangles_in_ball(const Vec3& centre,
                                                                            double radius,
                                                                            std::size_t most) const;

 private:
  struct Scene;
  std::unique_ptr<Scene> scene_;
};

// Nearest point of one triangle, degenerate ones included.
// Ericson, Real-Time Collision Detection (2005), section 5.1.5.
[[nodiscard]] Vec3 closest_on_triangle(const Vec3& query, const Vec3& a, const Vec3& b,
                                       const Vec3& c);

}  // namespace triglyph
