// Symmetric 3 x 3 matrices built as sums of outer products, such as covariance matrices and
// curvature tensors.
#pragma once

#include <array>
#include <cstddef>

#include "engine/geometry/vec3.h"

namespace triglyph {

struct PrincipalAxes {
  std::array<double, 3> values{};  // eigenvalues, descending
  std::array<Vec3, 3> axes;        // unit eigenvectors in the same order
};

class SymmetricMatrix {
 public:
  // Adds weight * v v^T.
  void add(const Vec3& v, double weight) {
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j <= i; ++j) lower_[i][j] += weight * v[i] * v[j];
    }
  }

  SymmetricMatrix& operator+=(const SymmetricMatrix& other) {
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j <= i; ++j) lower_[i][j] += other.lower_[i][j];
    }
    return *this;
  }
  SymmetricMatrix& operator*=(double factor) {
    for (std::array<double, 3>& row : lower_) {
      for (double& entry : row) entry *= factor;
    }
    return *this;
  }
  [[nodiscard]] double trace() const { return lower_[0][0] + lower_[1][1] + lower_[2][2]; }

  // Returns the eigenvalues and eigenvectors. An eigenvector's sign is arbitrary but deterministic.
  [[nodiscard]] PrincipalAxes principal_axes() const;

 private:
  std::array<std::array<double, 3>, 3> lower_{};
};

}  // namespace triglyph
