// A mesh as the schemes see it: distinct points and triangles over them.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "engine/mesh/vec3.h"

namespace triglyph {

using Triangle = std::array<std::uint32_t, 3>;

struct Mesh {
  std::vector<Vec3> positions;      // distinct points, model units; equal file coordinates are one
  std::vector<Triangle> triangles;  // counter-clockwise seen from outside; three distinct points
};

}  // namespace triglyph
