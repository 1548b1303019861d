#include "engine/attack/motions.h"

#include <cmath>
#include <utility>

#include "engine/base/random.h"
#include "engine/geometry/box.h"

namespace triglyph {
namespace {

Vec3 random_shift(double most, std::uint64_t seed) {
  return most * Vec3(2 * random_unit(seed, 0, 0) - 1, 2 * random_unit(seed, 0, 1) - 1,
                     2 * random_unit(seed, 0, 2) - 1);
}

}  // namespace

std::array<Vec3, 3> random_rotation(std::uint64_t seed) {
  std::array<double, 4> q{};
  double norm = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    q[i] = random_unit(seed, 0, i) + random_unit(seed, 1, i) - 1;
    norm += q[i] * q[i];
  }
  norm = std::sqrt(norm);
  const double w = q[0] / norm, x = q[1] / norm, y = q[2] / norm, z = q[3] / norm;
  return {Vec3(1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)),
          Vec3(2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)),
          Vec3(2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y))};
}

Mesh similarly_mapped(const Mesh& mesh, std::uint64_t seed) {
  const auto rotation = random_rotation(seed);
  const double scale = std::pow(10.0, 6 * random_unit(seed, 2, 0) - 3);
  const Vec3 shift = random_shift(scale * box_diagonal(mesh.positions), mix_bits(seed));
  Mesh result = mesh;
  for (Vec3& p : result.positions) p = scale * transformed(rotation, p) + shift;
  return result;
}

Mesh affinely_mapped(const Mesh& mesh, double condition, std::uint64_t seed) {
  const auto before = random_rotation(seed + 1000);
  const auto after = random_rotation(seed + 2000);
  const Vec3 stretch(condition, 1 + (condition - 1) * random_unit(seed, 5, 0), 1);
  const Vec3 shift = random_shift(box_diagonal(mesh.positions), mix_bits(seed));
  Mesh result = mesh;
  for (Vec3& p : result.positions) {
    const Vec3 turned = transformed(before, p);
    p = transformed(after,
                    Vec3(turned[0] * stretch[0], turned[1] * stretch[1], turned[2] * stretch[2])) +
        shift;
  }
  return result;
}

Mesh mirrored(const Mesh& mesh) {
  Mesh result = mesh;
  for (Vec3& p : result.positions) p[0] = -p[0];
  for (Triangle& t : result.triangles) std::swap(t[1], t[2]);
  return result;
}

}  // namespace triglyph
