// What tests of attacks measure shapes by.
#pragma once

#include "engine/mesh/mesh.h"
#include "tests/support/shapes.h"

namespace triglyph::test {

inline const Mesh& ball() {
  return bumpy_ball().mesh;
}

// The volume that the mesh encloses; below 0 if it is inside out.
inline double volume_of(const Mesh& mesh) {
  double six = 0;
  for (const Triangle& t : mesh.triangles) {
    six += dot(mesh.positions[t[0]], cross(mesh.positions[t[1]], mesh.positions[t[2]]));
  }
  return six / 6;
}

}  // namespace triglyph::test
