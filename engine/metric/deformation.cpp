#include "engine/metric/deformation.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/base/error.h"
#include "engine/base/parallel.h"

namespace triglyph {
namespace {

double plus(double a, double b) {
  return a + b;
}

double sum_of_squares(std::span<const Vec3> before, std::span<const Vec3> after) {
  return parallel_reduce(
      before.size(), 0.0, [&](std::size_t i) { return (after[i] - before[i]).sqrnorm(); }, plus);
}

struct Sides {
  Vec3 a, b;  // from corner 0 to corners 1 and 2
};

Sides sides_of(const Triangle& triangle, std::span<const Vec3> positions) {
  return {positions[triangle[1]] - positions[triangle[0]],
          positions[triangle[2]] - positions[triangle[0]]};
}

// A symmetric 2 x 2 matrix: the metric of a face in the basis of its sides.
struct FaceMetric {
  double aa, ab, bb;

  [[nodiscard]] double determinant() const { return aa * bb - ab * ab; }
};

FaceMetric metric_of(const Sides& sides) {
  return {dot(sides.a, sides.a), dot(sides.a, sides.b), dot(sides.b, sides.b)};
}

// Returns the strain energy density from one metric to another, times the area of the first. The
// stretches s and t are the singular values of the map: s^2 + t^2 and s^2 t^2 are the trace and the
// determinant of from^-1 to, in any basis.
double strain_energy(const FaceMetric& from, const FaceMetric& to) {
  const double determinant = from.determinant();
  if (!(determinant > 0)) return 0;
  const double trace = (from.bb * to.aa - 2 * from.ab * to.ab + from.aa * to.bb) / determinant;
  const double product = std::sqrt(std::max(0.0, to.determinant()) / determinant);
  const double sum = std::sqrt(std::max(0.0, trace + 2 * product));
  const double squares = std::max(0.0, trace - 2 * sum + 2);  // (s - 1)^2 + (t - 1)^2
  return std::sqrt(determinant) / 2 * squares / 2;
}

// The maximum and the weighted sums of angles.
struct Angles {
  double max = 0, sum = 0, weight = 0;
};

Angles angle_of(const Sides& before, const Sides& after) {
  const Vec3 n = cross(before.a, before.b);
  const Vec3 m = cross(after.a, after.b);
  if (!(n.sqrnorm() > 0 && m.sqrnorm() > 0)) return {};
  const double angle = std::atan2(cross(n, m).norm(), dot(n, m)) * 180 / M_PI;
  return {angle, angle * n.norm(), n.norm()};
}

}  // namespace

Displacement displacement(std::span<const Vec3> before, std::span<const Vec3> after) {
  check(before.size() == after.size(), "displacements need the same points");
  if (before.empty()) return {};
  const auto length = [&](std::size_t i) { return (after[i] - before[i]).norm(); };
  const double largest = parallel_reduce(before.size(), 0.0, length,
                                         [](double a, double b) { return std::max(a, b); });
  const auto count = static_cast<double>(before.size());
  return {largest, parallel_reduce(before.size(), 0.0, length, plus) / count,
          std::sqrt(sum_of_squares(before, after) / count)};
}

double signal_to_noise(std::span<const Vec3> before, std::span<const Vec3> after) {
  check(before.size() == after.size(), "a signal needs the same points");
  const double noise = sum_of_squares(before, after);
  if (!(noise > 0)) return std::numeric_limits<double>::infinity();
  const Vec3 sum = parallel_reduce(
      before.size(), Vec3(0, 0, 0), [&](std::size_t i) { return before[i]; },
      [](const Vec3& a, const Vec3& b) { return a + b; });
  const Vec3 centroid = sum / static_cast<double>(before.size());
  const double signal = parallel_reduce(
      before.size(), 0.0, [&](std::size_t i) { return (before[i] - centroid).sqrnorm(); }, plus);
  return 10 * std::log10(signal / noise);
}

double strain(std::span<const Triangle> triangles, std::span<const Vec3> before,
              std::span<const Vec3> after) {
  check(before.size() == after.size(), "a strain needs the same points");
  const double area = parallel_reduce(
      triangles.size(), 0.0,
      [&](std::size_t t) {
        const Sides sides = sides_of(triangles[t], before);
        return cross(sides.a, sides.b).norm() / 2;
      },
      plus);
  if (!(area > 0)) return 0;
  const double energy = parallel_reduce(
      triangles.size(), 0.0,
      [&](std::size_t t) {
        return strain_energy(metric_of(sides_of(triangles[t], before)),
                             metric_of(sides_of(triangles[t], after)));
      },
      plus);
  return std::sqrt(energy / area);
}

NormalDeviation normal_deviation(std::span<const Triangle> triangles, std::span<const Vec3> before,
                                 std::span<const Vec3> after) {
  check(before.size() == after.size(), "normals need the same points");
  const Angles all = parallel_reduce(
      triangles.size(), Angles{},
      [&](std::size_t t) {
        return angle_of(sides_of(triangles[t], before), sides_of(triangles[t], after));
      },
      [](const Angles& a, const Angles& b) {
        return Angles{std::max(a.max, b.max), a.sum + b.sum, a.weight + b.weight};
      });
  return {all.max, all.weight > 0 ? all.sum / all.weight : 0};
}

}  // namespace triglyph
