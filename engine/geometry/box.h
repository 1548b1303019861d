// Axis-aligned bounding boxes.
#pragma once

#include <limits>
#include <span>

#include "engine/geometry/vec3.h"

namespace triglyph {

// An axis-aligned box. Empty by default: `low` is above `high` until a point is added.
struct Box {
  Vec3 low{kFar, kFar, kFar};
  Vec3 high{-kFar, -kFar, -kFar};

  void extend(const Vec3& point) {
    low.minimize(point);
    high.maximize(point);
  }
  void extend(const Box& box) {
    low.minimize(box.low);
    high.maximize(box.high);
  }
  [[nodiscard]] Vec3 size() const { return high - low; }

 private:
  static constexpr double kFar = std::numeric_limits<double>::infinity();
};

// Returns the smallest box around the points. O(points).
[[nodiscard]] inline Box bounding_box(std::span<const Vec3> points) {
  Box box;
  for (const Vec3& point : points) box.extend(point);
  return box;
}

// Returns the length of the bounding box's diagonal in model units; 0 without points. O(points).
[[nodiscard]] inline double box_diagonal(std::span<const Vec3> points) {
  return points.empty() ? 0 : bounding_box(points).size().norm();
}

}  // namespace triglyph
