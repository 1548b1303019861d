// A shape with three different axes, bumps at many distances from its centre, and no plane.
#pragma once

#include <cmath>

#include "engine/mesh/mesh.h"
#include "tests/support/motions.h"

namespace triglyph::test {

// `rows` rows of twice as many columns.
inline Mesh knobbly(std::uint32_t rows) {
  Mesh mesh = sphere(rows, 1);
  for (Vec3& p : mesh.positions) {
    const double swell = 1 + 0.2 * std::sin(4 * p[0] + 1) * std::cos(3 * p[1]) +
                         0.15 * std::sin(5 * p[2] + 2 * p[0]);
    p = Vec3(1.7 * p[0], 1.1 * p[1], 0.75 * p[2]) * swell;
  }
  return mesh;
}

}  // namespace triglyph::test
