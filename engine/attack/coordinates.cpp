#include "engine/attack/coordinates.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "engine/base/parallel.h"
#include "engine/base/random.h"
#include "engine/geometry/box.h"
#include "engine/mesh/uniform_flow.h"

namespace triglyph {
namespace {

// The nearest half float: 11 significant bits, of which the last is worth at least 2^-24.
double nearest_half(double x) {
  if (x == 0) return 0;
  const double last_bit = std::ldexp(1.0, std::max(std::ilogb(x) - 10, -24));
  return std::nearbyint(x / last_bit) * last_bit;
}

}  // namespace

Mesh with_uniform_noise(const Mesh& mesh, double intensity, std::uint64_t seed) {
  Vec3 centroid(0, 0, 0);
  for (const Vec3& p : mesh.positions) centroid += p / static_cast<double>(mesh.positions.size());
  double radius = 0;
  for (const Vec3& p : mesh.positions) radius += (p - centroid).norm();
  radius /= static_cast<double>(mesh.positions.size());
  Mesh result = mesh;
  for (std::size_t i = 0; i < result.positions.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      result.positions[i][axis] += (2 * random_unit(seed, axis, i) - 1) * intensity * radius;
    }
  }
  return result;
}

Mesh smoothed(const Mesh& mesh, int rounds, double step) {
  return {UniformFlow(mesh, step).smoothed(mesh.positions, rounds), mesh.triangles};
}

Mesh quantised(const Mesh& mesh, int bits) {
  const auto [low, high] = bounding_box(mesh.positions);
  Mesh result = mesh;
  for (Vec3& p : result.positions) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double step = std::ldexp(high[axis] - low[axis], -bits);
      if (step > 0) p[axis] = low[axis] + std::round((p[axis] - low[axis]) / step) * step;
    }
  }
  return result;
}

Mesh quantised_to_cubes(const Mesh& mesh, int bits) {
  const Box box = bounding_box(mesh.positions);
  const double step = box.size().max() / (std::ldexp(1.0, bits) - 1);
  Mesh result = mesh;
  if (!(step > 0)) return result;
  for (Vec3& p : result.positions) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      p[axis] = box.low[axis] + std::round((p[axis] - box.low[axis]) / step) * step;
    }
  }
  return result;
}

Vec3 with_significant_digits(const Vec3& point, int digits) {
  Vec3 result;
  for (std::size_t i = 0; i < 3; ++i) {
    std::array<char, 64> text{};
    std::snprintf(text.data(), text.size(), "%.*g", digits, point[i]);
    result[i] = std::strtod(text.data(), nullptr);
  }
  return result;
}

Mesh with_significant_digits(const Mesh& mesh, int digits) {
  Mesh result = mesh;
  for (Vec3& p : result.positions) p = with_significant_digits(p, digits);
  return result;
}

Mesh as_half_floats(const Mesh& mesh) {
  const Box box = bounding_box(mesh.positions);
  const Vec3 centre = (box.low + box.high) / 2;
  const double half_side = box.size().max() / 2;
  Mesh result = mesh;
  if (!(half_side > 0)) return result;
  for (Vec3& p : result.positions) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      p[axis] = nearest_half((p[axis] - centre[axis]) / half_side);
    }
  }
  return result;
}

}  // namespace triglyph
