// Shapes with known curvature, and motions with known effect.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "engine/base/random.h"
#include "engine/mesh/mesh.h"

namespace triglyph::test {

inline Vec3 turned(const Vec3& p) {
  const double c = std::cos(0.7), s = std::sin(0.7);
  const Vec3 q(c * p[0] - s * p[1], s * p[0] + c * p[1], p[2]);
  return {q[0], c * q[1] - s * q[2], s * q[1] + c * q[2]};
}

// The mesh turned, then scaled, then shifted.
inline Mesh moved_rigidly(Mesh mesh, double scale = 1, const Vec3& shift = Vec3(3, -2, 5)) {
  for (Vec3& p : mesh.positions) p = turned(p) * scale + shift;
  return mesh;
}

// Every coordinate changed by up to `size`.
inline Mesh shaken(Mesh mesh, double size, std::uint64_t seed) {
  for (std::uint64_t i = 0; i < mesh.positions.size(); ++i) {
    for (std::uint64_t axis = 0; axis < 3; ++axis) {
      mesh.positions[i][axis] += size * (2 * random_unit(seed, axis, i) - 1);
    }
  }
  return mesh;
}

// A tube about the z axis, open at both ends.
inline Mesh tube(std::uint32_t around, std::uint32_t along, double radius, double length) {
  Mesh mesh;
  for (std::uint32_t z = 0; z <= along; ++z) {
    for (std::uint32_t i = 0; i < around; ++i) {
      const double angle = 2 * M_PI * i / around;
      mesh.positions.emplace_back(radius * std::cos(angle), radius * std::sin(angle),
                                  length * z / along);
    }
  }
  const auto at = [&](std::uint32_t i, std::uint32_t z) { return z * around + i % around; };
  for (std::uint32_t z = 0; z < along; ++z) {
    for (std::uint32_t i = 0; i < around; ++i) {
      mesh.triangles.push_back({at(i, z), at(i + 1, z), at(i + 1, z + 1)});
      mesh.triangles.push_back({at(i, z), at(i + 1, z + 1), at(i, z + 1)});
    }
  }
  return mesh;
}

// A globe about the origin: triangles between `parts` rows and twice as many columns.
inline Mesh sphere(std::uint32_t parts, double radius) {
  Mesh mesh;
  const std::uint32_t around = 2 * parts;
  mesh.positions.emplace_back(0, 0, -radius);
  for (std::uint32_t row = 1; row < parts; ++row) {
    const double height = -M_PI / 2 + M_PI * row / parts;
    for (std::uint32_t i = 0; i < around; ++i) {
      const double angle = 2 * M_PI * i / around;
      mesh.positions.push_back(Vec3(std::cos(height) * std::cos(angle),
                                    std::cos(height) * std::sin(angle), std::sin(height)) *
                               radius);
    }
  }
  mesh.positions.emplace_back(0, 0, radius);
  const auto at = [&](std::uint32_t i, std::uint32_t row) {
    return 1 + (row - 1) * around + i % around;
  };
  const auto top = static_cast<std::uint32_t>(mesh.positions.size() - 1);
  for (std::uint32_t i = 0; i < around; ++i) {
    mesh.triangles.push_back({0, at(i + 1, 1), at(i, 1)});
    mesh.triangles.push_back({top, at(i, parts - 1), at(i + 1, parts - 1)});
    for (std::uint32_t row = 1; row + 1 < parts; ++row) {
      mesh.triangles.push_back({at(i, row), at(i + 1, row), at(i + 1, row + 1)});
      mesh.triangles.push_back({at(i, row), at(i + 1, row + 1), at(i, row + 1)});
    }
  }
  return mesh;
}

}  // namespace triglyph::test
