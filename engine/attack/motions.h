// Attacks that map space: the shape as seen from elsewhere, stretched, or in a mirror. Each returns
// a changed copy.
#pragma once

#include <array>
#include <cstdint>

#include "engine/mesh/mesh.h"

namespace triglyph {

// Returns the rows of a rotation that is drawn uniformly (Shoemake: a random quaternion).
[[nodiscard]] std::array<Vec3, 3> random_rotation(std::uint64_t seed);

[[nodiscard]] inline Vec3 transformed(const std::array<Vec3, 3>& rows, const Vec3& p) {
  return Vec3(dot(rows[0], p), dot(rows[1], p), dot(rows[2], p));
}

// A random rotation, a scale of 1e-3 to 1e3, evenly among its powers, and a shift of up to one
// diagonal along each axis. O(points).
[[nodiscard]] Mesh similarly_mapped(const Mesh& mesh, std::uint64_t seed);

// A random affine map whose greatest and least stretch are `condition` >= 1 apart, with a shift
// likewise. It keeps the orientation. O(points).
[[nodiscard]] Mesh affinely_mapped(const Mesh& mesh, double condition, std::uint64_t seed);

// The mirror image, left for right. The corners of the faces are turned over too, so that outside
// stays outside. O(points + triangles).
[[nodiscard]] Mesh mirrored(const Mesh& mesh);

}  // namespace triglyph
