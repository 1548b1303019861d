// Welding: one point for all file vertices with equal coordinates.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/geometry/vec3.h"

namespace triglyph {

struct Weld {
  std::vector<Vec3> points;                    // in order of first appearance; no -0
  std::vector<std::uint32_t> point_of_vertex;  // one entry per file vertex
};

// Returns the distinct points and the point of every vertex. Coordinates are equal if their bits
// are, -0 counting as 0; there is no tolerance. The result is the same for any number of threads.
// Precondition: fewer than 2^32 - 1 vertices, all finite. O(n) expected.
[[nodiscard]] Weld weld(std::span<const Vec3> vertices);

}  // namespace triglyph
