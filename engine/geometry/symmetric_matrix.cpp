#include "engine/geometry/symmetric_matrix.h"

#include <Eigen/Eigenvalues>

namespace triglyph {

PrincipalAxes SymmetricMatrix::principal_axes() const {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j <= i; ++j) {
      matrix(i, j) = lower_[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
      matrix(j, i) = matrix(i, j);
    }
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(matrix);
  PrincipalAxes principal;
  for (int i = 0; i < 3; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const Eigen::Vector3d axis = solver.eigenvectors().col(2 - i);
    principal.axes[at] = Vec3(axis[0], axis[1], axis[2]);
    principal.values[at] = solver.eigenvalues()[2 - i];
  }
  return principal;
}

}  // namespace triglyph
