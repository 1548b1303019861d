// A mesh as the schemes see it: distinct points and triangles over them.
#pragma once

#include <vector>

#include "engine/geometry/triangle.h"
#include "engine/geometry/vec3.h"

namespace triglyph {

struct Mesh {
  std::vector<Vec3> positions;      // distinct points, model units; equal file coordinates are one
  std::vector<Triangle> triangles;  // counter-clockwise seen from outside; three distinct points
};

}  // namespace triglyph
