#include "engine/scheme/aie/affine_norm.h"

#include <algorithm>
#include <cmath>

#include "engine/geometry/symmetric_matrix.h"

namespace triglyph {
namespace {

constexpr int kMaxSteps = 60;
constexpr double kPrecision = 1e-14;

}  // namespace

AffineNorm::AffineNorm(const std::array<Vec3, 4>& basis, double plane_below)
    : mean_((basis[0] + basis[1] + basis[2] + basis[3]) / 4) {
  SymmetricMatrix covariance;
  for (const Vec3& point : basis) covariance.add(point - mean_, 0.25);
  const PrincipalAxes principal = covariance.principal_axes();
  axes_ = principal.axes;
  for (std::size_t i = 0; i < 3; ++i) {
    deviations_[i] = std::sqrt(std::max(0.0, principal.values[i]));
  }
  flatness_ = deviations_[0] > 0 ? deviations_[2] / deviations_[0] : 0;
  straightness_ = deviations_[0] > 0 ? deviations_[1] / deviations_[0] : 0;
  dimensions_ = flatness_ < plane_below ? 2 : 3;
}

std::array<double, 3> AffineNorm::coordinates(const Vec3& point) const {
  const Vec3 offset = point - mean_;
  return {dot(axes_[0], offset), dot(axes_[1], offset), dot(axes_[2], offset)};
}

double AffineNorm::operator()(const Vec3& point) const {
  const std::array<double, 3> y = coordinates(point);
  double squared = 0;
  for (std::size_t i = 0; i < dimensions_; ++i) {
    squared += (y[i] / deviations_[i]) * (y[i] / deviations_[i]);
  }
  return std::sqrt(squared);
}

double AffineNorm::height(const Vec3& point) const {
  return std::abs(coordinates(point)[2]) / deviations_[0];
}

// With z the nearest point, y - z is normal to the ellipsoid: y_i = z_i (1 + mu / s_i), s_i the
// squared deviation, and sum z_i^2 / s_i = value^2 has one root mu above the pole -s_min.
Vec3 AffineNorm::nearest_with_norm(const Vec3& point, double value) const {
  const std::array<double, 3> y = coordinates(point);
  const std::size_t last = dimensions_ - 1;  // the axis of least deviation
  const double least = deviations_[last] * deviations_[last];
  // in units of `least`: mu = least * (t - 1), t > 0
  std::array<double, 3> ratio{};
  for (std::size_t i = 0; i < dimensions_; ++i) {
    ratio[i] = deviations_[i] * deviations_[i] / least;
  }
  const auto shrunk = [&](std::size_t i, double t) { return ratio[i] / (ratio[i] - 1 + t); };
  const double wanted = value * value;
  // norm^2 of z and its derivative by t
  const auto squared_norm = [&](double t, double& slope) {
    double sum = 0;
    slope = 0;
    for (std::size_t i = 0; i < dimensions_; ++i) {
      const double scaled = shrunk(i, t) * y[i] / deviations_[i];
      sum += scaled * scaled;
      slope -= 2 * scaled * scaled / (ratio[i] - 1 + t);
    }
    return sum;
  };
  // the root lies above |y_last| / deviation / value, where the last term alone reaches the value,
  // and below the bound at which all terms together cannot
  double low = std::abs(y[last]) / deviations_[last] / value;
  double high = low;
  for (std::size_t i = 0; i < last; ++i) {
    high += ratio[i] * std::abs(y[i]) / deviations_[i] / value;
  }
  double t = std::max(low, kPrecision);
  double slope = 0;
  // Newton on 1 / norm, which is nearly linear in t and exactly so for a single term
  for (int step = 0; step < kMaxSteps && low < high; ++step) {
    const double squared = squared_norm(t, slope);
    (squared >= wanted ? low : high) = t;
    double next = t + 2 * squared * (1 - std::sqrt(squared) / value) / slope;
    if (!(next > low && next < high)) next = (low + high) / 2;
    if (std::abs(next - t) <= kPrecision * t) break;
    t = next;
  }

  std::array<double, 3> z = y;
  double others = 0;
  for (std::size_t i = 0; i < dimensions_; ++i) {
    z[i] = shrunk(i, t) * y[i];
    if (i != last) others += (z[i] / deviations_[i]) * (z[i] / deviations_[i]);
  }
  // what rounding left over goes along the last axis, the cheapest; this also serves points in the
  // plane of the two others, for which the root is the pole itself
  if (others < wanted) {
    const double reach = deviations_[last] * std::sqrt(wanted - others);
    if (t <= 2 * kPrecision || std::abs(z[last]) > 0) z[last] = std::copysign(reach, y[last]);
  }
  Vec3 nearest = mean_;
  for (std::size_t i = 0; i < 3; ++i) nearest += axes_[i] * z[i];
  return nearest;
}

}  // namespace triglyph
