// The shape of a triangle up to similarity as two numbers, and back: the arithmetic of TSQ.
// With the base from (0, 0) to (1, 0) and the apex above it at (x, height):
//
//            apex                height = distance of the apex from the base / base
//           /    \               log_ratio = log(|apex - start| / |apex - end|)
//      start ---- end
//
// Ohbuchi, Masuda, Aono, ACM Multimedia 1997: {height / base, ratio of the other two edges}; the
// logarithm makes the ratio symmetric under exchange of the two edges.
#pragma once

#include <array>
#include <cmath>
#include <optional>

#include "engine/geometry/vec3.h"

namespace triglyph {

struct TriangleShape {
  double height = 0;
  double log_ratio = 0;
};

// A triangle laid into the plane: base length in model units, apex in units of the base.
struct FlatTriangle {
  double base = 0;
  double x = 0;
  double height = 0;

  [[nodiscard]] TriangleShape shape() const {
    const double start = x * x + height * height;
    const double end = (x - 1) * (x - 1) + height * height;
    return {height, 0.5 * std::log(start / end)};
  }
};

// Lays a triangle into the plane. A degenerate one gives base or height 0, or NaN. O(1).
[[nodiscard]] inline FlatTriangle flatten(const Vec3& start, const Vec3& end, const Vec3& apex) {
  const Vec3 base = end - start;
  const Vec3 side = apex - start;
  const double base_squared = dot(base, base);
  return {std::sqrt(base_squared), dot(base, side) / base_squared,
          cross(base, side).norm() / base_squared};
}

// Returns the x of the apex of the given shape that lies nearest to `near_x`, in units of the base;
// nothing if no triangle has the shape. The line at the height meets the circle of Apollonius of
// the ratio where
//   T y^2 - y + T (1/4 + height^2) = 0,   T = tanh(log_ratio), y = x - 1/2.
[[nodiscard]] inline std::optional<double> apex_x(double height, double tanh_log_ratio,
                                                  double near_x) {
  const double product = 0.25 + height * height;
  const double discriminant = 1 - 4 * tanh_log_ratio * tanh_log_ratio * product;
  if (!(discriminant >= 0)) return std::nullopt;
  const double inner = 2 * tanh_log_ratio * product / (1 + std::sqrt(discriminant));
  const double near_y = near_x - 0.5;
  if (inner == 0) return 0.5;  // ratio 1: the circle is the bisector, its other point at infinity
  const double outer = product / inner;
  return 0.5 + (std::abs(inner - near_y) <= std::abs(outer - near_y) ? inner : outer);
}

// The three corners of a triangle in its own plane, model units: the origin lies at the start of
// the unmoved base, x runs along it.
struct FlatCorners {
  std::array<double, 3> x{};  // start, end, apex
  std::array<double, 3> y{};
};

// Returns where the corners go if the triangle takes the shape whose apex lies at (x, height), in
// units of the base: that copy of the shape, among all similar ones, that moves the corners least
// in the sense of least squares (complex Procrustes). O(1).
[[nodiscard]] FlatCorners reshape(const FlatTriangle& triangle, double x, double height);

}  // namespace triglyph
