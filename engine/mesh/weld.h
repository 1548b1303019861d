// One point for all file vertices with equal coordinates.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/geometry/vec3.h"

namespace triglyph {

struct Weld {
  std::vector<Vec3> points;                    // in order of first appearance; no -0
  std::vector<std::uint32_t> point_of_vertex;  // one a file vertex
};

// Equal means the same bits once -0 is 0: no tolerance, so points that are merely close stay two.
// The result is the same for any number of threads. O(n) expected.
// Precondition: fewer than 2^32 - 1 vertices, all finite.
[[nodiscard]] Weld weld(std::span<const Vec3> vertices);

}  // namespace triglyph
