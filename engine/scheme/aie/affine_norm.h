// The affine-invariant norm of a point relative to four others.
// Foley, Nielson. Knot selection for parametric spline interpolation (1989); used for marks by
// Benedens, Busch. Towards blind detection of robust watermarks in polygonal models (2000).
#pragma once

#include <array>

#include "engine/geometry/vec3.h"

namespace triglyph {

// ||P||^2 = (P - m)^T S^-1 (P - m), with m and S mean and covariance of the basis: unchanged under
// every affine map of all five points. Where the basis lies in a plane S is singular, and the norm
// is that of the plane: a distance from it neither counts nor changes.
class AffineNorm {
 public:
  // `flatness` below which a basis counts as plane.
  AffineNorm(const std::array<Vec3, 4>& basis, double plane_below);

  // Thickness of the basis: least over greatest deviation, sqrt of the ratio of S's eigenvalues.
  // 0: in one plane. Not affine invariant: a map changes it up to its condition number.
  [[nodiscard]] double flatness() const { return flatness_; }
  // Middle over greatest deviation; 0: on one line, where there is no norm.
  [[nodiscard]] double straightness() const { return straightness_; }
  // Of the basis.
  [[nodiscard]] const Vec3& mean() const { return mean_; }
  // Model units.
  [[nodiscard]] double greatest_deviation() const { return deviations_[0]; }
  [[nodiscard]] bool is_plane() const { return dimensions_ == 2; }

  // 0 at the mean, sqrt(3) (or sqrt(2) to sqrt(3) in a plane) at the basis points.
  [[nodiscard]] double operator()(const Vec3& point) const;

  // The point nearest to `point` whose norm is `value` > 0.
  // By the secular equation of an ellipsoid. O(1), a handful of Newton steps.
  // Eberly. Distance from a point to an ellipse, an ellipsoid, or a hyperellipsoid (2013).
  [[nodiscard]] Vec3 nearest_with_norm(const Vec3& point, double value) const;

  // Distance from the plane of a plane basis, in deviations along its greatest axis.
  [[nodiscard]] double height(const Vec3& point) const;

 private:
  [[nodiscard]] std::array<double, 3> coordinates(const Vec3& point) const;

  Vec3 mean_;
  std::array<Vec3, 3> axes_;          // of S, greatest first
  std::array<double, 3> deviations_;  // sqrt of the eigenvalues
  double flatness_;
  double straightness_;
  std::size_t dimensions_;
};

}  // namespace triglyph
