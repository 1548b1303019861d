// The points of a mesh that belong to its surface.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/mesh/mesh.h"

namespace triglyph {

// Returns the points that triangles use, ascending. The others, stray points, are not seen and do
// not count for the size of a mesh, its views and its distances. O(points + triangles).
[[nodiscard]] std::vector<std::uint32_t> surface_points(const Mesh& mesh);

}  // namespace triglyph
