// A mesh as a file would hold it.
#pragma once

#include <span>
#include <vector>

#include "engine/mesh/mesh.h"

namespace triglyph {

// Returns the nearest point whose coordinates are floats, the numbers of most mesh files.
[[nodiscard]] Vec3 as_float(const Vec3& point);

// Returns the mesh as it is read back from a file of floats: coordinates are rounded, points at
// equal coordinates are one, triangles that thereby repeat a point are gone. O(points + triangles).
[[nodiscard]] Mesh stored(const Mesh& mesh);

// Returns the mesh of the triangles that have three distinct corners and of the points that they
// use, in the order of both. O(points + triangles).
[[nodiscard]] Mesh compacted(std::span<const Vec3> points, std::span<const Triangle> triangles);

}  // namespace triglyph
