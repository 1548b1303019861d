// The triangle mesh that schemes and metrics work on.
#pragma once

#include <vector>

#include "engine/geometry/triangle.h"
#include "engine/geometry/vec3.h"

namespace triglyph {

struct Mesh {
  std::vector<Vec3> positions;      // model units; vertices at equal coordinates are one point
  std::vector<Triangle> triangles;  // three distinct points, counter-clockwise seen from outside
};

}  // namespace triglyph
