// What happens to meshes on their way, as tests call it: the attacks of engine/attack, and some
// that tests alone need. Each function returns a changed copy, deterministic by seed.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "engine/attack/coordinates.h"
#include "engine/attack/indexing.h"
#include "engine/attack/motions.h"
#include "engine/attack/stored_mesh.h"
#include "engine/base/random.h"
#include "engine/mesh/mesh.h"

namespace triglyph::test {

using triglyph::as_float;
using triglyph::quantised;
using triglyph::random_rotation;
using triglyph::transformed;
using triglyph::with_significant_digits;
using triglyph::with_uniform_noise;

// New order of vertices and faces, and every face starts at another corner.
inline Mesh shuffled(const Mesh& mesh, std::uint64_t seed) {
  return reordered(mesh, seed);
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

}  // namespace triglyph::test
