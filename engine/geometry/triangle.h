// Triangles as triples of point indices, with their normals and areas.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "engine/geometry/vec3.h"

namespace triglyph {

using Triangle = std::array<std::uint32_t, 3>;

// Returns the normal of triangle a, b, c by the right-hand rule. Its length is twice the triangle's
// area, 0 if the triangle is degenerate.
[[nodiscard]] constexpr Vec3 area_normal(const Vec3& a, const Vec3& b, const Vec3& c) {
  return cross(b - a, c - a);
}
[[nodiscard]] constexpr Vec3 area_normal(std::span<const Vec3> positions,
                                         const Triangle& triangle) {
  return area_normal(positions[triangle[0]], positions[triangle[1]], positions[triangle[2]]);
}

// Returns the triangle's area in squared model units.
[[nodiscard]] inline double triangle_area(std::span<const Vec3> positions,
                                          const Triangle& triangle) {
  return area_normal(positions, triangle).norm() / 2;
}

}  // namespace triglyph
