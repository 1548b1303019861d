// Meshes in few bytes, for a database: positions of 16 bits an axis, compressed by meshoptimizer.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "engine/mesh/mesh.h"

namespace triglyph {

// Returns the mesh with positions rounded to 2^-16 of the longest side of its box. Triangles keep
// their order and their sides, but may begin with another corner. O(points + triangles).
[[nodiscard]] std::vector<char> packed(const Mesh& mesh);

// Returns the mesh that was packed; nothing for bytes that packed() did not make. Takes memory in
// proportion to the bytes. O(bytes).
[[nodiscard]] std::optional<Mesh> unpacked(std::span<const char> bytes);

}  // namespace triglyph
