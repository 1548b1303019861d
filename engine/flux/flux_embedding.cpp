#include "engine/flux/flux_embedding.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Dense>

#include "engine/base/parallel.h"
#include "engine/base/random.h"
#include "engine/flux/evidence.h"
#include "engine/geometry/box.h"
#include "engine/mesh/surface_diagonal.h"

namespace triglyph {
namespace {

// Fields are smooth below this length, in units of the frame's scale: waves of it are neither seen
// nor smoothed away.
constexpr double kSmoothLength = 0.1;

// Axes whose spreads differ by less than this share turn with any noise.
constexpr double kLeastSpreadGap = 0.002;

// Fewer functionals cannot carry the least payload beside what a reader must be sure of.
constexpr std::size_t kLeastUsed = 20;

// Points for each functional: with fewer, the displacement has no freedom to be smooth.
constexpr std::size_t kLeastPointsEach = 5;

// Residuals at which a mark that cannot come closer is given up.
constexpr double kMostResidual = 0.1;

// Directions in the space of changes that respond less than this, relative to the strongest, are
// not used: they would move the surface far.
constexpr double kLeastResponse = 1e-3;

// Share of the bending energy beside the mean square in what the choice of cells minimises.
constexpr double kEnergyShare = 0.5;

constexpr int kMostSweeps = 30;

// Residuals, root mean square in steps, at which the functionals are where they should be.
constexpr double kResidual = 0.01;
constexpr int kMostCorrections = 6;

// Faces that turn farther, degrees, make their neighbourhood follow less.
constexpr double kMostTurn = 25;
constexpr int kMostRounds = 3;
// After these only faces that are turned over count, whose corners stay where they are.
constexpr int kMostRoundsWithFlips = 6;
constexpr double kCornerFollows = 0.35;
constexpr double kRingFollows = 0.6;

// Noise of this share of the mean distance to the centre, and coordinates of so many bits, are what
// a mark of normal strength must survive.
constexpr double kUsualNoise = 0.003;
constexpr int kUsualBits = 9;

// What any mark must survive: a file format with few digits.
constexpr double kLittleNoise = 0.001;
constexpr int kLittleBits = 11;

// Points of which a part is read: more tell hardly more.
constexpr std::size_t kMostSeen = 8000;

// Turns, shifts and the scale.
constexpr Eigen::Index kSimilarities = 7;

// Offsets that are read are wrong by about this share of the diagonal, and neighbouring ones alike,
// so that this many of them tell as much as one.
constexpr double kUsualOffset = 1e-4;
constexpr double kNeighbours = 10;

// Marks change normalised functionals by about this much.
constexpr double kUsualChange = 0.005;

std::vector<Vec3> outward_directions(const Mesh& mesh) {
  std::vector<Vec3> normals(mesh.positions.size());
  for (const Triangle& t : mesh.triangles) {
    const Vec3 normal = area_normal(mesh.positions, t);
    for (const std::uint32_t point : t) normals[point] += normal;
  }
  for (Vec3& normal : normals) {
    const double length = normal.norm();
    normal = length > 0 ? normal / length : Vec3();
  }
  return normals;
}

// Returns the frame with its axes in the order and with the signs that come closest to another's.
SolidFrame aligned(const SolidFrame& frame, const SolidFrame& other) {
  SolidFrame result = frame;
  double best = -1;
  std::array<std::size_t, 3> order = {0, 1, 2};
  do {
    double fit = 0;
    for (std::size_t a = 0; a < 3; ++a) {
      fit += std::abs(dot(frame.axes[order[a]], other.axes[a]));
    }
    if (fit <= best) continue;
    best = fit;
    for (std::size_t a = 0; a < 3; ++a) {
      const Vec3& axis = frame.axes[order[a]];
      result.axes[a] = dot(axis, other.axes[a]) < 0 ? -axis : axis;
    }
  } while (std::next_permutation(order.begin(), order.end()));
  return result;
}

}  // namespace

// The displacements of the unknowns, one column a functional, that change it by one and leave the
// other functionals and the frame; and what sums of them cost.
struct FluxCanvas::Basis {
  Eigen::MatrixXd responses;
  Eigen::MatrixXd energy;
  Eigen::MatrixXd squares;  // mean square of the moves, model units

  // Returns the root mean square of the moves for changes of the functionals, model units.
  [[nodiscard]] double rms(const Eigen::VectorXd& changes) const {
    return std::sqrt(std::max(0.0, changes.dot(squares * changes)));
  }
};

FluxCanvas::~FluxCanvas() = default;

std::optional<FluxSolid> FluxSolid::of(const Surface& surface) {
  const ClosedMesh closed(surface);
  const std::vector<Vec3> positions = closed.with_centres(surface.mesh.positions);
  const auto frame = closed.frame(positions);
  if (!frame) return std::nullopt;
  return FluxSolid{*frame, flux_values(positions, closed.triangles(), *frame)};
}

FluxCanvas::FluxCanvas(const Surface& surface) : surface_(surface), closed_(surface) {
  const Mesh& mesh = surface.mesh;
  diagonal_ = surface_diagonal(mesh);
  const std::vector<Vec3> positions = closed_.with_centres(mesh.positions);
  const auto frame = closed_.frame(positions);
  if (!frame) {
    obstacle_ = FluxObstacle::NoVolume;
    return;
  }
  frame_ = *frame;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    if (frame_.spreads[axis] < (1 + kLeastSpreadGap) * frame_.spreads[axis + 1]) {
      obstacle_ = FluxObstacle::NoAxes;
      return;
    }
  }
  before_ = measured(flux_values(positions, closed_.triangles(), frame_));
  prepare(positions);
  if (obstacle_ != FluxObstacle::None) return;
  usual_noise_ = noise_of(kUsualNoise, kUsualBits);
  little_noise_ = noise_of(kLittleNoise, kLittleBits);
}

FluxCanvas::FluxCanvas(const Surface& surface, const FluxSolid& solid)
    : surface_(surface),
      closed_(surface),
      diagonal_(surface_diagonal(surface.mesh)),
      frame_(solid.frame),
      before_(measured(solid.values)) {
  prepare(closed_.with_centres(surface.mesh.positions));
}

void FluxCanvas::prepare(const std::vector<Vec3>& positions) {
  const Mesh& mesh = surface_.mesh;
  for (std::uint32_t i = 0; i < kFunctionals; ++i) {
    if (before_[i].used >= 0.5) used_.push_back(i);
  }
  if (used_.size() < kLeastUsed || mesh.positions.size() < kLeastPointsEach * used_.size()) {
    obstacle_ = FluxObstacle::TooNarrow;
    return;
  }
  directions_ = outward_directions(mesh);
  plate_.emplace(mesh, kSmoothLength * frame_.scale);
  Mesh closed{positions, {closed_.triangles().begin(), closed_.triangles().end()}};
  const PointFaces faces = point_faces(closed);
  derivatives_ = flux_derivatives(positions, closed_.triangles(), faces, directions_, frame_);
  frame_rows_ = frame_rows(positions, closed_.triangles(), faces, directions_, frame_);
  basis_ = make_basis(std::vector<double>(mesh.positions.size(), 1));
}

std::shared_ptr<const FluxCanvas::Basis> FluxCanvas::make_basis(
    std::span<const double> weights) const {
  const std::size_t count = used_.size();
  std::array<std::int32_t, kFunctionals> place{};
  place.fill(-1);
  std::vector<double> unit(kFunctionals, 0);
  for (std::size_t i = 0; i < count; ++i) {
    place[used_[i]] = static_cast<std::int32_t>(i);
    unit[used_[i]] = 1 / rung_unit(before_[used_[i]].rung);
  }
  const Columns rows = plate_->restricted(
      count + kFrameRows,
      [&](std::size_t point, const std::function<void(std::size_t, double)>& add) {
        const double weight = weights[point];
        for (const FluxDerivatives::Entry& entry : derivatives_.at(point)) {
          const std::int32_t at = place[entry.functional];
          if (at < 0) continue;
          add(static_cast<std::size_t>(at), weight * unit[entry.functional] * entry.value);
        }
        for (std::size_t r = 0; r < kFrameRows; ++r) {
          add(count + r, weight * frame_rows_[point][r]);
        }
      });
  const Columns solved = plate_->solved(rows);
  const auto unknowns = static_cast<Eigen::Index>(rows.rows);
  const auto width = static_cast<Eigen::Index>(rows.count);
  const auto wanted = static_cast<Eigen::Index>(count);
  const Eigen::Map<const Eigen::MatrixXd> right(rows.values.data(), unknowns, width);
  const Eigen::Map<const Eigen::MatrixXd> fields(solved.values.data(), unknowns, width);
  const Eigen::MatrixXd gram = right.transpose() * fields;
  const Eigen::VectorXd scale =
      gram.diagonal().cwiseMax(std::numeric_limits<double>::min()).cwiseSqrt().cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(scale.asDiagonal() * gram *
                                                              scale.asDiagonal());
  const Eigen::VectorXd values =
      solver.eigenvalues().cwiseMax(kLeastResponse * solver.eigenvalues().maxCoeff());
  const Eigen::MatrixXd inverse = scale.asDiagonal() * solver.eigenvectors() *
                                  values.cwiseInverse().asDiagonal() *
                                  solver.eigenvectors().transpose() * scale.asDiagonal();
  auto basis = std::make_shared<Basis>();
  basis->responses = fields * inverse.leftCols(wanted);
  basis->energy = inverse.topLeftCorner(wanted, wanted);
  std::vector<double> areas(plate_->areas().begin(), plate_->areas().end());
  double total = 0;
  for (std::size_t point = 0; point < areas.size(); ++point) {
    total += areas[point];
    areas[point] *= weights[point] * weights[point];
  }
  const std::vector<double> mass = plate_->restricted_weight(areas);
  const Eigen::Map<const Eigen::VectorXd> squares(mass.data(), unknowns);
  basis->squares = basis->responses.transpose() * squares.asDiagonal() * basis->responses / total;
  return basis;
}

// Returns the changes of the functionals to values that have the phases: first the nearest, then
// whatever single change by a cell makes the weighted sum of squares and energy less.
std::vector<double> FluxCanvas::changes(const Basis& basis, const FluxPhases& phases,
                                        const Dither& dither, double step) const {
  const auto count = static_cast<Eigen::Index>(used_.size());
  const Eigen::MatrixXd cost = kEnergyShare / basis.energy.trace() * basis.energy +
                               (1 - kEnergyShare) / basis.squares.trace() * basis.squares;
  Eigen::VectorXd change(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const std::uint32_t functional = used_[static_cast<std::size_t>(i)];
    const Measured& m = before_[functional];
    const double goal = dither.of(functional, m.rung) + phases[functional];
    const double place = m.value / step - goal;
    change[i] = step * (std::round(place) - place);
  }
  const double enough = 1e-9 * change.dot(cost * change);
  Eigen::VectorXd slope = cost * change;
  bool improved = true;
  for (int sweep = 0; improved && sweep < kMostSweeps; ++sweep) {
    improved = false;
    for (Eigen::Index i = 0; i < count; ++i) {
      for (const double cell : {-step, step}) {
        if (2 * cell * slope[i] + cell * cell * cost(i, i) >= -enough) continue;
        change[i] += cell;
        slope += cell * cost.col(i);
        improved = true;
        break;
      }
    }
  }
  return {change.data(), change.data() + count};
}

std::vector<Vec3> FluxCanvas::moved(std::span<const double> unknowns,
                                    std::span<const double> weights) const {
  const std::vector<double> field = plate_->field(unknowns);
  std::vector<Vec3> positions = surface_.mesh.positions;
  for (std::size_t point = 0; point < positions.size(); ++point) {
    positions[point] += weights[point] * field[point] * directions_[point];
  }
  return positions;
}

std::vector<double> FluxCanvas::used_values(std::span<const Vec3> positions) const {
  const std::vector<Vec3> all = closed_.with_centres(positions);
  const auto frame = closed_.frame(all);
  if (!frame) return {};
  const FluxValues values = flux_values(all, closed_.triangles(), aligned(*frame, frame_));
  std::vector<double> result;
  for (const std::uint32_t i : used_) {
    result.push_back(values.flux[i] / rung_unit(before_[i].rung));
  }
  return result;
}

bool FluxCanvas::follow_less(std::span<const Vec3> positions, bool only_flipped,
                             std::vector<double>& weights) const {
  const std::vector<Vec3>& before = surface_.mesh.positions;
  const double least_cosine = only_flipped ? 0 : std::cos(kMostTurn / 180 * M_PI);
  std::vector<char> corner(before.size(), 0);
  std::vector<char> ring(before.size(), 0);
  bool found = false;
  for (const Triangle& t : surface_.mesh.triangles) {
    const Vec3 old_normal = area_normal(before, t);
    const Vec3 new_normal = area_normal(positions, t);
    const double lengths = old_normal.norm() * new_normal.norm();
    if (!(lengths > 0) || dot(old_normal, new_normal) >= least_cosine * lengths) continue;
    found = true;
    for (const std::uint32_t point : t) corner[point] = 1;
  }
  if (!found) return false;
  for (const Triangle& t : surface_.mesh.triangles) {
    if (corner[t[0]] + corner[t[1]] + corner[t[2]] == 0) continue;
    for (const std::uint32_t point : t) ring[point] = 1;
  }
  for (std::size_t point = 0; point < before.size(); ++point) {
    if (ring[point] != 0) weights[point] *= kRingFollows;
    if (corner[point] != 0) weights[point] *= only_flipped ? 0 : kCornerFollows;
  }
  return true;
}

std::optional<FluxCanvas::Written> FluxCanvas::write(const FluxPhases& phases, const Dither& dither,
                                                     const FluxLimits& limits) const {
  if (obstacle_ != FluxObstacle::None) return std::nullopt;
  const double most = limits.rms_percent / 100 * diagonal_;
  const auto count = static_cast<Eigen::Index>(used_.size());
  std::vector<double> weights(surface_.mesh.positions.size(), 1);
  std::shared_ptr<const Basis> basis = basis_;
  std::optional<Written> written;
  for (int round = 0;; ++round) {
    // the largest step that stays within the limit
    std::vector<double> goal;
    std::size_t step = kSteps;
    while (step > 0) {
      --step;
      goal = changes(*basis, phases, dither, step_size(step));
      if (basis->rms(Eigen::Map<const Eigen::VectorXd>(goal.data(), count)) <= most) break;
      if (step == 0) return std::nullopt;
    }
    Eigen::VectorXd unknowns = Eigen::VectorXd::Zero(basis->responses.rows());
    Eigen::VectorXd rest = Eigen::Map<const Eigen::VectorXd>(goal.data(), count);
    double last = std::numeric_limits<double>::infinity();
    for (int correction = 0; correction < kMostCorrections; ++correction) {
      stop_point();
      const Eigen::VectorXd trial = unknowns + basis->responses * rest;
      std::vector<Vec3> positions =
          moved({trial.data(), static_cast<std::size_t>(trial.size())}, weights);
      const std::vector<double> values = used_values(positions);
      if (values.empty()) return std::nullopt;
      Eigen::VectorXd trial_rest(count);
      for (Eigen::Index i = 0; i < count; ++i) {
        const auto at = static_cast<std::size_t>(i);
        trial_rest[i] = before_[used_[at]].value + goal[at] - values[at];
      }
      const double residual =
          std::sqrt(trial_rest.squaredNorm() / static_cast<double>(count)) / step_size(step);
      if (residual >= last) break;  // as close as it gets
      const double rms = std::sqrt(std::max(0.0, squared_move(positions))) / diagonal_ * 100;
      written = Written{std::move(positions), step, rms, residual};
      unknowns = trial;
      rest = trial_rest;
      if (residual < kResidual) break;
      last = residual;
    }
    const bool only_flipped = round >= kMostRounds;
    if (round == kMostRoundsWithFlips || !written) break;
    if (!follow_less(written->positions, only_flipped, weights)) break;
    basis = make_basis(weights);
  }
  if (written && written->residual > kMostResidual) return std::nullopt;
  return written;
}

// Least squares of the offsets along the normals, as sums of the fields of the functionals and of
// a small similarity by which the part was brought to its place wrongly.
FluxCanvas::Estimate FluxCanvas::estimated(std::span<const std::optional<Vec3>> places) const {
  const std::vector<Vec3>& positions = surface_.mesh.positions;
  std::vector<std::size_t> seen;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (places[i]) seen.push_back(i);
  }
  const std::size_t stride = std::max<std::size_t>(1, seen.size() / kMostSeen);
  std::vector<std::size_t> points;
  for (std::size_t i = 0; i < seen.size(); i += stride) points.push_back(seen[i]);
  const auto rows = static_cast<Eigen::Index>(points.size());
  const auto count = static_cast<Eigen::Index>(used_.size());
  Eigen::MatrixXd fields(rows, count + kSimilarities);
  for (Eigen::Index i = 0; i < count; ++i) {
    stop_point();
    const Eigen::VectorXd unknowns = basis_->responses.col(i);
    const std::vector<double> field =
        plate_->field({unknowns.data(), static_cast<std::size_t>(unknowns.size())});
    for (Eigen::Index row = 0; row < rows; ++row) {
      fields(row, i) = field[points[static_cast<std::size_t>(row)]];
    }
  }
  Eigen::VectorXd offsets(rows);
  for (Eigen::Index row = 0; row < rows; ++row) {
    const std::size_t point = points[static_cast<std::size_t>(row)];
    const Vec3 arm = frame_.relative(positions[point]);
    const Vec3 turn = cross(arm, directions_[point]);
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      fields(row, count + axis) = frame_.scale * turn[static_cast<std::size_t>(axis)];
      fields(row, count + 3 + axis) =
          frame_.scale * directions_[point][static_cast<std::size_t>(axis)];
    }
    fields(row, count + 6) = frame_.scale * dot(arm, directions_[point]);
    offsets[row] = dot(*places[point] - positions[point], directions_[point]);
  }
  Eigen::MatrixXd squares = fields.transpose() * fields;
  // what is known in advance: changes are small
  const double noise = kUsualOffset * diagonal_;
  const double prior = noise * noise / (kUsualChange * kUsualChange);
  for (Eigen::Index i = 0; i < count + kSimilarities; ++i) squares(i, i) += prior;
  const Eigen::MatrixXd inverse =
      squares.ldlt().solve(Eigen::MatrixXd::Identity(count + kSimilarities, count + kSimilarities));
  const Eigen::VectorXd changes = inverse * (fields.transpose() * offsets);
  const double misfit =
      rows > 0 ? (offsets - fields * changes).squaredNorm() / static_cast<double>(rows) : 0;
  Estimate result{before_, {}};
  result.doubts.fill(std::numeric_limits<double>::infinity());
  for (Measured& m : result.measurement) m.used = 0;
  for (Eigen::Index i = 0; i < count; ++i) {
    const std::uint32_t functional = used_[static_cast<std::size_t>(i)];
    result.measurement[functional].used = 1;
    result.measurement[functional].other_weight = 0;
    result.measurement[functional].value = before_[functional].value + changes[i];
    result.doubts[functional] =
        std::sqrt(std::max(0.0, inverse(i, i)) * kNeighbours * (misfit + noise * noise));
  }
  return result;
}

double FluxCanvas::squared_move(std::span<const Vec3> positions) const {
  const std::span<const double> areas = plate_->areas();
  double sum = 0;
  double total = 0;
  for (std::size_t point = 0; point < positions.size(); ++point) {
    total += areas[point];
    sum += areas[point] * (positions[point] - surface_.mesh.positions[point]).sqrnorm();
  }
  return sum / total;
}

std::vector<std::vector<double>> FluxCanvas::noise_of(double amplitude, int bits) const {
  const std::vector<Vec3>& positions = surface_.mesh.positions;
  std::vector<std::vector<double>> changes;
  const auto add_change = [&](const std::vector<Vec3>& disturbed) {
    std::vector<double> values = used_values(disturbed);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] -= before_[used_[i]].value;
    if (!values.empty()) changes.push_back(std::move(values));
  };
  double distance = 0;
  for (const Vec3& p : positions) distance += (p - frame_.centre).norm();
  distance /= static_cast<double>(positions.size());
  std::vector<Vec3> disturbed = positions;
  for (std::size_t i = 0; i < disturbed.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      disturbed[i][axis] += amplitude * distance * (2 * random_unit(1, axis, i) - 1);
    }
  }
  add_change(disturbed);
  disturbed = positions;
  const double cell = bounding_box(positions).size().max() / std::ldexp(1.0, bits);
  for (Vec3& p : disturbed) {
    for (std::size_t axis = 0; axis < 3; ++axis) p[axis] = std::round(p[axis] / cell) * cell;
  }
  add_change(disturbed);
  return changes;
}

FluxExpectation FluxCanvas::expected_evidence(std::size_t step) const {
  const auto least = [&](const std::vector<std::vector<double>>& noises) {
    double bits = noises.empty() ? 0 : std::numeric_limits<double>::infinity();
    for (const std::vector<double>& noise : noises) {
      double sum = 0;
      for (const double change : noise) sum += std::cos(2 * M_PI * change / step_size(step));
      bits = std::min(bits, cosine_evidence(sum, noise.size()));
    }
    return bits;
  };
  return {least(usual_noise_), least(little_noise_)};
}

std::optional<std::size_t> FluxCanvas::expected_step(const FluxLimits& limits) const {
  if (obstacle_ != FluxObstacle::None) return std::nullopt;
  // fixed phases stand for any key
  const Dither dither(Key::trial());
  const double most = limits.rms_percent / 100 * diagonal_;
  for (std::size_t step = kSteps; step-- > 0;) {
    const std::vector<double> goal = changes(*basis_, {}, dither, step_size(step));
    const Eigen::Map<const Eigen::VectorXd> change(goal.data(),
                                                   static_cast<Eigen::Index>(goal.size()));
    if (basis_->rms(change) <= most) return step;
  }
  return std::nullopt;
}

}  // namespace triglyph
