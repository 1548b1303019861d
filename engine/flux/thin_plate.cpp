#include "engine/flux/thin_plate.h"

#include <algorithm>
#include <cmath>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include "engine/base/error.h"
#include "engine/base/parallel.h"
#include "engine/flux/cotangents.h"

namespace triglyph {
namespace {

using Sparse = Eigen::SparseMatrix<double, Eigen::RowMajor, std::int32_t>;

// Up to this size the points themselves are the unknowns: the factorisation and a hundred solutions
// take a quarter of a second.
constexpr std::size_t kMostUnknowns = 12000;

// Of a damped Jacobi step: 4/3 over the largest eigenvalue of D^-1 K, which is below 2.
constexpr double kDamping = 2.0 / 3;

// Smoothing steps after interpolation, which take the grain of the aggregates away.
constexpr int kFinalSmoothing = 3;

Sparse stiffness(const Mesh& mesh, std::span<const double> areas, double length) {
  std::vector<Eigen::Triplet<double, std::int32_t>> entries;
  entries.reserve(mesh.triangles.size() * 12 + areas.size());
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const std::uint32_t b = t[(corner + 1) % 3];
      const std::uint32_t c = t[(corner + 2) % 3];
      const double weight =
          cotangent_weight(mesh.positions[t[corner]], mesh.positions[b], mesh.positions[c]);
      const auto i = static_cast<std::int32_t>(b);
      const auto j = static_cast<std::int32_t>(c);
      entries.emplace_back(i, j, -weight);
      entries.emplace_back(j, i, -weight);
      entries.emplace_back(i, i, weight);
      entries.emplace_back(j, j, weight);
    }
  }
  for (std::size_t point = 0; point < areas.size(); ++point) {
    const auto i = static_cast<std::int32_t>(point);
    entries.emplace_back(i, i, areas[point] / (length * length));
  }
  Sparse matrix(static_cast<Eigen::Index>(areas.size()), static_cast<Eigen::Index>(areas.size()));
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

// Joins each point to a seed: points whose neighbours are all free become seeds, the rest goes to a
// neighbour's seed. Returns the aggregate of each point.
std::vector<std::int32_t> aggregates(const Sparse& matrix, std::int32_t& count) {
  constexpr std::int32_t kFree = -1;
  std::vector<std::int32_t> owner(static_cast<std::size_t>(matrix.rows()), kFree);
  const auto neighbours = [&](std::size_t row, const auto& visit) {
    for (Sparse::InnerIterator entry(matrix, static_cast<Eigen::Index>(row)); entry; ++entry) {
      if (static_cast<std::size_t>(entry.col()) != row) {
        visit(static_cast<std::size_t>(entry.col()), entry.value());
      }
    }
  };
  count = 0;
  for (std::size_t row = 0; row < owner.size(); ++row) {
    bool is_free = owner[row] == kFree;
    neighbours(row, [&](std::size_t other, double) { is_free &= owner[other] == kFree; });
    if (!is_free) continue;
    owner[row] = count;
    neighbours(row, [&](std::size_t other, double) { owner[other] = count; });
    ++count;
  }
  std::vector<std::int32_t> joined = owner;
  for (std::size_t row = 0; row < owner.size(); ++row) {
    if (owner[row] != kFree) continue;
    double strongest = 0;
    neighbours(row, [&](std::size_t other, double value) {
      if (owner[other] != kFree && -value > strongest) {
        strongest = -value;
        joined[row] = owner[other];
      }
    });
    if (joined[row] == kFree) joined[row] = count++;
  }
  return joined;
}

// Returns the interpolation from aggregates: their indicators after one damped Jacobi step.
Sparse interpolation(const Sparse& matrix) {
  std::int32_t count = 0;
  const std::vector<std::int32_t> owner = aggregates(matrix, count);
  Sparse indicators(matrix.rows(), count);
  indicators.reserve(Eigen::VectorXi::Constant(matrix.rows(), 1));
  for (std::size_t row = 0; row < owner.size(); ++row) {
    indicators.insert(static_cast<Eigen::Index>(row), owner[row]) = 1;
  }
  indicators.makeCompressed();
  Sparse change = matrix * indicators;
  const Eigen::VectorXd scale = kDamping * matrix.diagonal().cwiseInverse();
  change = scale.asDiagonal() * change;
  return indicators - change;
}

}  // namespace

struct ThinPlate::Parts {
  std::vector<double> areas;
  Sparse fine;                // K of the points; kept if there are interpolations
  std::vector<Sparse> steps;  // interpolations, from the finest
  Eigen::VectorXd mass;       // of the unknowns
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors;
};

ThinPlate::ThinPlate(const Mesh& mesh, double length) : parts_(std::make_unique<Parts>()) {
  parts_->areas = point_areas(mesh);
  parts_->mass = Eigen::Map<const Eigen::VectorXd>(parts_->areas.data(),
                                                   static_cast<Eigen::Index>(parts_->areas.size()));
  Sparse matrix = stiffness(mesh, parts_->areas, length);
  if (static_cast<std::size_t>(matrix.rows()) > kMostUnknowns) parts_->fine = matrix;
  while (static_cast<std::size_t>(matrix.rows()) > kMostUnknowns) {
    stop_point();
    Sparse step = interpolation(matrix);
    if (step.cols() == step.rows()) break;  // nothing is connected
    const Sparse half = matrix * step;
    matrix = Sparse(step.transpose()) * half;
    parts_->mass = (step.transpose() * parts_->mass).eval();
    parts_->steps.push_back(std::move(step));
  }
  parts_->mass = parts_->mass.cwiseMax(1e-6 * parts_->mass.mean());
  stop_point();
  parts_->factors.compute(Eigen::SparseMatrix<double>(matrix));
  check(parts_->factors.info() == Eigen::Success, "the thin plate's matrix is not positive");
}

ThinPlate::~ThinPlate() = default;

std::size_t ThinPlate::unknowns() const {
  return static_cast<std::size_t>(parts_->mass.size());
}

std::span<const double> ThinPlate::areas() const {
  return parts_->areas;
}

Columns ThinPlate::restricted(std::size_t functionals, const Row& row) const {
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const std::size_t points = parts_->areas.size();
  const auto width = static_cast<Eigen::Index>(functionals);
  const std::vector<Sparse>& steps = parts_->steps;
  const std::size_t first = steps.empty() ? points : static_cast<std::size_t>(steps[0].cols());
  Rows values = Rows::Zero(static_cast<Eigen::Index>(first), width);
  if (steps.empty()) {
    parallel_for(
        points,
        [&](std::size_t point) {
          row(point, [&](std::size_t functional, double value) {
            values(static_cast<Eigen::Index>(point), static_cast<Eigen::Index>(functional)) +=
                value;
          });
        },
        kBlock);
  } else {
    // the unknowns gather from their points, so that each sums in one order
    const Sparse gather = steps[0].transpose();
    parallel_for(
        first,
        [&](std::size_t unknown) {
          const auto at = static_cast<Eigen::Index>(unknown);
          for (Sparse::InnerIterator entry(gather, at); entry; ++entry) {
            row(static_cast<std::size_t>(entry.col()), [&](std::size_t functional, double value) {
              values(at, static_cast<Eigen::Index>(functional)) += entry.value() * value;
            });
          }
        },
        kBlock);
  }
  for (std::size_t step = 1; step < steps.size(); ++step) {
    values = (steps[step].transpose() * values).eval();
  }
  Columns result(unknowns(), functionals);
  Eigen::Map<Eigen::MatrixXd>(result.values.data(), values.rows(), width) = values;
  return result;
}

std::vector<double> ThinPlate::restricted_weight(std::span<const double> weights) const {
  Eigen::VectorXd values =
      Eigen::Map<const Eigen::VectorXd>(weights.data(), static_cast<Eigen::Index>(weights.size()));
  for (const Sparse& step : parts_->steps) {
    values = (step.transpose() * values).eval().cwiseMax(0.0);
  }
  return {values.data(), values.data() + values.size()};
}

Columns ThinPlate::solved(const Columns& columns) const {
  Columns result(columns.rows, columns.count);
  const auto rows = static_cast<Eigen::Index>(columns.rows);
  parallel_for(columns.count, [&](std::size_t i) {
    const Eigen::Map<const Eigen::VectorXd> right(columns.column(i).data(), rows);
    Eigen::VectorXd once = parts_->factors.solve(right);
    once.array() *= parts_->mass.array();
    Eigen::Map<Eigen::VectorXd>(result.column(i).data(), rows) = parts_->factors.solve(once);
  });
  return result;
}

std::vector<double> ThinPlate::field(std::span<const double> unknowns) const {
  Eigen::VectorXd values = Eigen::Map<const Eigen::VectorXd>(
      unknowns.data(), static_cast<Eigen::Index>(unknowns.size()));
  for (auto step = parts_->steps.rbegin(); step != parts_->steps.rend(); ++step) {
    values = (*step * values).eval();
  }
  if (!parts_->steps.empty()) {
    const Eigen::VectorXd scale = kDamping * parts_->fine.diagonal().cwiseInverse();
    for (int i = 0; i < kFinalSmoothing; ++i) {
      values -= scale.cwiseProduct(parts_->fine * values).eval();
    }
  }
  return {values.data(), values.data() + values.size()};
}

}  // namespace triglyph
