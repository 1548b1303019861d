// The part of a surface that can be nearest to a moved triangle, to which distance queries are
// limited.
#pragma once

#include <span>
#include <vector>

#include "engine/mesh/mesh.h"

namespace triglyph {

// Returns a superset, in input order, of the triangles that come within reach of a moved triangle
// before or after the move; the reach of a moved triangle is the greatest distance that its corners
// moved. The moved triangles themselves are included. O(triangles), with a grid whose cells are
// about as wide as the moved triangles.
[[nodiscard]] std::vector<Triangle> nearby_triangles(std::span<const Triangle> triangles,
                                                     std::span<const Triangle> moved,
                                                     std::span<const Vec3> before,
                                                     std::span<const Vec3> after);

}  // namespace triglyph
