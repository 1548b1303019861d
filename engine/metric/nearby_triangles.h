// The part of a surface that a small change can be near to: what a distance query needs to look at.
#pragma once

#include <span>
#include <vector>

#include "engine/mesh/mesh.h"

namespace triglyph {

// A superset, in order, of the triangles that come within reach of a moved triangle, before or
// after; a moved triangle's reach is the farthest move of its corners. The moved triangles
// themselves are in it. O(triangles) with a grid of cells the size of the moved triangles.
[[nodiscard]] std::vector<Triangle> nearby_triangles(std::span<const Triangle> triangles,
                                                     std::span<const Triangle> moved,
                                                     std::span<const Vec3> before,
                                                     std::span<const Vec3> after);

}  // namespace triglyph
