// The affine-invariant norm of a point relative to four others, the basis.
//
// This work is based on:
// Foley, Nielson. Knot selection for parametric spline interpolation (1989).
// Benedens, Busch. Towards blind detection of robust watermarks in polygonal models. Eurographics
// 2000: the norm as carrier of a mark.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "engine/geometry/vec3.h"

namespace triglyph {

// N(P)^2 = (P - m)^T S^-1 (P - m), with m and S the mean and the covariance of the basis.
// Affine maps of all five points leave it unchanged. Where the basis lies in a plane, S is singular
// and the norm is that of the plane: the distance of P from the plane does not count.
class AffineNorm {
 public:
  // A basis counts as plane if its flatness lies below `plane_below`. O(1): one eigenvalue problem.
  AffineNorm(const std::array<Vec3, 4>& basis, double plane_below);

  // Returns the least over the greatest standard deviation of the basis, 0 to 1; 0: it lies in a
  // plane. Deviations are the roots of S's eigenvalues. An affine map changes it by up to the map's
  // condition number.
  [[nodiscard]] double flatness() const { return flatness_; }
  // Returns the middle over the greatest deviation, 0 to 1; 0: the basis lies on a line, and there
  // is no norm.
  [[nodiscard]] double straightness() const { return straightness_; }
  // Returns the mean of the basis.
  [[nodiscard]] const Vec3& mean() const { return mean_; }
  // Returns the greatest deviation, model units.
  [[nodiscard]] double greatest_deviation() const { return deviations_[0]; }
  [[nodiscard]] bool is_plane() const { return dimensions_ == 2; }

  // Returns the norm of a point: 0 at the mean, sqrt(3) at the points of a solid basis, up to
  // sqrt(3) at those of a plane one. Precondition: straightness() > 0. O(1).
  [[nodiscard]] double operator()(const Vec3& point) const;

  // Returns the point nearest to `point` whose norm is `value` > 0: the foot on an ellipsoid, from
  // the root of its secular equation. O(1), some ten Newton steps.
  // Eberly. Distance from a point to an ellipse, an ellipsoid, or a hyperellipsoid (2013).
  [[nodiscard]] Vec3 nearest_with_norm(const Vec3& point, double value) const;

  // Returns a lower bound on the distance between a point of the one norm and a point of the other,
  // model units: nowhere does the norm change faster than along the axis of least deviation.
  [[nodiscard]] double least_distance(double one_norm, double other_norm) const {
    return std::abs(one_norm - other_norm) * deviations_[dimensions_ - 1];
  }

  // Returns the distance of a point from the plane of a plane basis, in greatest deviations.
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
