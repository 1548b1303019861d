// What happens to meshes on their way: each function returns a changed copy, deterministic by seed.
#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numeric>
#include <vector>

#include "engine/base/random.h"
#include "engine/geometry/box.h"
#include "engine/mesh/mesh.h"

namespace triglyph::test {

inline std::vector<std::uint32_t> random_order(std::size_t size, std::uint64_t seed) {
  std::vector<std::uint32_t> order(size);
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return random_bits(seed, 0, a) < random_bits(seed, 0, b);
  });
  return order;
}

// New order of vertices and faces, and every face starts at another corner.
inline Mesh shuffled(const Mesh& mesh, std::uint64_t seed) {
  const auto points = random_order(mesh.positions.size(), seed);
  const auto faces = random_order(mesh.triangles.size(), seed + 1);
  std::vector<std::uint32_t> place(points.size());
  Mesh result;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    place[points[i]] = i;
    result.positions.push_back(mesh.positions[points[i]]);
  }
  for (const std::uint32_t face : faces) {
    const Triangle& old = mesh.triangles[face];
    const auto turn = static_cast<std::size_t>(random_bits(seed, 2, face) % 3);
    result.triangles.push_back(
        {place[old[turn]], place[old[(turn + 1) % 3]], place[old[(turn + 2) % 3]]});
  }
  return result;
}

// Rotation by a uniform random quaternion, as rows.
inline std::array<Vec3, 3> random_rotation(std::uint64_t seed) {
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

inline Vec3 transformed(const std::array<Vec3, 3>& rows, const Vec3& p) {
  return Vec3(dot(rows[0], p), dot(rows[1], p), dot(rows[2], p));
}

// Random rotation (uniform quaternion), scale from 1e-3 to 1e3, shift of up to ten mesh sizes.
// What an exporter does that winds triangles the other way round.
inline Mesh turned_inside_out(Mesh mesh) {
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

// The mirror image, whose triangles are wound so that they face inwards.
inline Mesh mirrored(Mesh mesh) {
  for (Vec3& p : mesh.positions) p[0] = -p[0];
  return mesh;
}

inline Mesh moved_rigidly_and_scaled(const Mesh& mesh, std::uint64_t seed) {
  const auto rotation = random_rotation(seed);
  const double scale = std::pow(10.0, 6 * random_unit(seed, 2, 0) - 3);
  Mesh result = mesh;
  for (Vec3& p : result.positions) {
    p = transformed(rotation, p) * scale + Vec3(3, -5, 7) * scale * random_unit(seed, 3, 0);
  }
  return result;
}

// Random affine map whose greatest and least stretch are `condition` apart; a reflection keeps the
// faces' order of corners, so it turns the surface inside out.
inline Mesh affinely_mapped(const Mesh& mesh, double condition, bool reflect, std::uint64_t seed) {
  const auto before = random_rotation(seed + 1000);
  const auto after = random_rotation(seed + 2000);
  const Vec3 stretch(condition, 1 + (condition - 1) * random_unit(seed, 5, 0), reflect ? -1 : 1);
  Mesh result = mesh;
  for (Vec3& p : result.positions) {
    const Vec3 turned = transformed(before, p);
    p = transformed(after,
                    Vec3(turned[0] * stretch[0], turned[1] * stretch[1], turned[2] * stretch[2])) +
        Vec3(3, -5, 7) * random_unit(seed, 6, 0);
  }
  return result;
}

// Keeps the faces whose centroid lies on one side of a plane with random direction that halves
// them.
inline Mesh cropped_half(const Mesh& mesh, std::uint64_t seed) {
  const Vec3 normal(random_unit(seed, 0, 0) - 0.5, random_unit(seed, 0, 1) - 0.5,
                    random_unit(seed, 0, 2) - 0.5);
  std::vector<double> heights;
  for (const Triangle& t : mesh.triangles) {
    heights.push_back(
        dot(normal, mesh.positions[t[0]] + mesh.positions[t[1]] + mesh.positions[t[2]]));
  }
  std::vector<double> sorted = heights;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<long>(sorted.size() / 2),
                   sorted.end());
  const double median = sorted[sorted.size() / 2];
  Mesh result;
  std::vector<std::uint32_t> place(mesh.positions.size(), 0xffffffff);
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    if (heights[f] >= median) continue;
    Triangle triangle{};
    for (std::size_t i = 0; i < 3; ++i) {
      std::uint32_t& id = place[mesh.triangles[f][i]];
      if (id == 0xffffffff) {
        id = static_cast<std::uint32_t>(result.positions.size());
        result.positions.push_back(mesh.positions[mesh.triangles[f][i]]);
      }
      triangle[i] = id;
    }
    result.triangles.push_back(triangle);
  }
  return result;
}

// Every coordinate shifted by up to `intensity` times the mean distance of the points from their
// centroid, uniformly. Wang, Lavoue, Denis, Baskurt, He. A benchmark for 3D mesh watermarking
// (2010).
inline Mesh with_uniform_noise(const Mesh& mesh, double intensity, std::uint64_t seed) {
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

// Coordinates rounded to multiples of 2^-bits of the box's side, an axis at a time: the same
// benchmark.
inline Mesh quantised(const Mesh& mesh, int bits) {
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

// Coordinates as "%.{digits}g" would write them.
inline Vec3 with_significant_digits(const Vec3& p, int digits) {
  Vec3 result;
  for (std::size_t i = 0; i < 3; ++i) {
    char text[64];
    std::snprintf(text, sizeof text, "%.*g", digits, p[i]);
    result[i] = std::strtod(text, nullptr);
  }
  return result;
}

inline Mesh with_significant_digits(const Mesh& mesh, int digits) {
  Mesh result = mesh;
  for (Vec3& p : result.positions) p = with_significant_digits(p, digits);
  return result;
}

inline Vec3 as_float(const Vec3& p) {
  return Vec3(static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2]));
}

}  // namespace triglyph::test
