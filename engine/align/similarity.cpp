#include "engine/align/similarity.h"

#include <Eigen/Dense>

namespace triglyph {
namespace {

// Points whose second spread is smaller than this share of the first lie on a line, about which
// they may turn.
constexpr double kFlat = 1e-6;

Eigen::Vector3d as_eigen(const Vec3& v) {
  return {v[0], v[1], v[2]};
}

}  // namespace

Similarity combined(const Similarity& first, const Similarity& second) {
  Similarity both;
  both.scale = second.scale * first.scale;
  for (std::size_t row = 0; row < 3; ++row) {
    both.rows[row] = first.rows[0] * second.rows[row][0] + first.rows[1] * second.rows[row][1] +
                     first.rows[2] * second.rows[row][2];
  }
  both.shift = second(first.shift);
  return both;
}

std::optional<Similarity> fitted_similarity(std::span<const PointPair> pairs) {
  if (pairs.size() < 3) return std::nullopt;
  const auto count = static_cast<double>(pairs.size());
  Eigen::Vector3d from = Eigen::Vector3d::Zero(), to = from;
  for (const PointPair& pair : pairs) {
    from += as_eigen(pair.from) / count;
    to += as_eigen(pair.to) / count;
  }
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d spread = covariance;
  for (const PointPair& pair : pairs) {
    const Eigen::Vector3d a = as_eigen(pair.from) - from;
    covariance += (as_eigen(pair.to) - to) * a.transpose();
    spread += a * a.transpose();
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance,
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Vector3d values = svd.singularValues();
  if (!(values[0] > 0) || values[1] <= kFlat * values[0] || !(spread.trace() > 0)) {
    return std::nullopt;
  }
  // points in a plane do not tell a mirror image from a turn, which is likelier
  Eigen::Vector3d signs(1, 1, 1);
  if (values[2] <= kFlat * values[0]) {
    signs[2] = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1;
  }
  const Eigen::Matrix3d turn = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  Similarity result;
  result.scale = values.dot(signs) / spread.trace();
  const Eigen::Vector3d shift = to - result.scale * turn * from;
  for (Eigen::Index row = 0; row < 3; ++row) {
    result.rows[static_cast<std::size_t>(row)] = Vec3(turn(row, 0), turn(row, 1), turn(row, 2));
  }
  result.shift = Vec3(shift[0], shift[1], shift[2]);
  if (!(result.scale > 0)) return std::nullopt;
  return result;
}

}  // namespace triglyph
