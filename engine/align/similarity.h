// Similarities, mirror images among them, and those that bring points to other points.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "engine/geometry/vec3.h"

namespace triglyph {

struct Similarity {
  double scale = 1;
  // Rows of an orthogonal matrix; its determinant is -1 for a mirror image.
  std::array<Vec3, 3> rows = {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)};
  Vec3 shift{0, 0, 0};  // model units, after scaling

  [[nodiscard]] Vec3 operator()(const Vec3& point) const {
    return Vec3(dot(rows[0], point), dot(rows[1], point), dot(rows[2], point)) * scale + shift;
  }
};

// Returns the similarity that does the first and then the second.
[[nodiscard]] Similarity combined(const Similarity& first, const Similarity& second);

// Two places of one point.
struct PointPair {
  Vec3 from;
  Vec3 to;
};

// Returns the similarity that brings the first places to the second ones with the least sum of
// squared distances; nothing for fewer than three pairs, or for points on a line. O(pairs).
// This work is based on:
// Umeyama. Least-squares estimation of transformation parameters between two point patterns. IEEE
// Transactions on Pattern Analysis and Machine Intelligence 13 (1991).
[[nodiscard]] std::optional<Similarity> fitted_similarity(std::span<const PointPair> pairs);

}  // namespace triglyph
