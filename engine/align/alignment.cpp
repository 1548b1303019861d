#include "engine/align/alignment.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include <Eigen/Dense>

#include "engine/base/parallel.h"
#include "engine/base/random.h"
#include "engine/base/stop.h"
#include "engine/geometry/box.h"
#include "engine/geometry/spatial_index.h"
#include "engine/geometry/symmetric_matrix.h"

namespace triglyph {
namespace {

// Shares of the original's diagonal.
constexpr double kClose = 0.01;         // what lies on the original lies within
constexpr double kFarthestPull = 0.02;  // of points that pull at first
constexpr double kNearestPull = 0.002;  // and in the end

constexpr double kLeastOverlap = 0.5;
constexpr double kSureOverlap = 0.9;  // no other way is tried

// Ways that are this nearly as good as the best are returned as well, unless they are the same
// but for this share of the diagonal.
constexpr double kAsGood = 0.9;
constexpr double kSameWay = 0.001;
constexpr std::size_t kMostAlignments = 4;

constexpr std::size_t kJudges = 400;    // points by which a way is judged
constexpr std::size_t kPullers = 4000;  // points by which the suspect is moved closer
constexpr int kMostPulls = 40;

// Rings of neighbours that make a point's surroundings: with fewer, many look alike.
constexpr int kRings = 4;

// Pairs without which surroundings prove nothing.
constexpr std::size_t kLeastPairs = 8;

// Distances whose ratios differ by less may be the same.
constexpr double kSameRatio = 0.01;

// Points, each of which lies at an even distance in the list of all.
std::vector<Vec3> some_points(std::span<const Vec3> positions, std::size_t most) {
  std::vector<Vec3> points;
  const std::size_t count = std::min(most, positions.size());
  for (std::size_t i = 0; i < count; ++i) points.push_back(positions[i * positions.size() / count]);
  return points;
}

enum class Handedness { Same, Mirrored };

// Numbers that agree where points have the same surroundings: how many triangles they, their
// neighbours and so on have, in what order. This work is based on: Weisfeiler, Leman. The reduction
// of a graph to canonical form and the algebra which appears therein (1968).
std::vector<std::uint64_t> surroundings(const Mesh& mesh, Handedness handedness) {
  std::vector<std::uint64_t> colours(mesh.positions.size(), 0), next(colours.size());
  for (int ring = 0; ring < kRings; ++ring) {
    std::fill(next.begin(), next.end(), 0);
    for (const Triangle& t : mesh.triangles) {
      for (std::size_t corner = 0; corner < 3; ++corner) {
        std::uint64_t first = colours[t[(corner + 1) % 3]];
        std::uint64_t second = colours[t[(corner + 2) % 3]];
        if (handedness == Handedness::Mirrored) std::swap(first, second);
        next[t[corner]] += mix_bits(mix_bits(first) ^ second);  // whatever the order of triangles
      }
    }
    for (std::size_t i = 0; i < next.size(); ++i)
      next[i] = mix_bits(colours[i] ^ mix_bits(next[i]));
    std::swap(colours, next);
  }
  return colours;
}

constexpr std::uint32_t kSeveral = 0xffffffff;

// Returns the point that alone has each number.
std::unordered_map<std::uint64_t, std::uint32_t> unique_points(
    std::span<const std::uint64_t> colours) {
  std::unordered_map<std::uint64_t, std::uint32_t> points;
  for (std::uint32_t i = 0; i < colours.size(); ++i) {
    const auto [known, is_new] = points.emplace(colours[i], i);
    if (!is_new) known->second = kSeveral;
  }
  return points;
}

// Returns the similarity of points that correspond, without those that it leaves far away.
std::optional<Similarity> trimmed_similarity(std::vector<PointPair> pairs) {
  std::optional<Similarity> fitted;
  for (int round = 0; round < 6 && pairs.size() >= kLeastPairs; ++round) {
    fitted = fitted_similarity(pairs);
    if (!fitted) return std::nullopt;
    std::vector<double> distances;
    for (const PointPair& pair : pairs)
      distances.push_back(((*fitted)(pair.from) - pair.to).norm());
    std::vector<double> sorted = distances;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    const double most = 4 * *middle;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      if (distances[i] <= most) pairs[kept++] = pairs[i];
    }
    if (kept == pairs.size()) break;
    pairs.resize(kept);
  }
  return fitted;
}

// Returns the numbers of points that no other point has, and 0 for others.
std::vector<std::uint64_t> unique_surroundings(const Mesh& mesh, Handedness handedness) {
  std::vector<std::uint64_t> colours = surroundings(mesh, handedness);
  const auto points = unique_points(colours);
  for (std::uint64_t& colour : colours) {
    if (points.at(colour) == kSeveral) colour = 0;
  }
  return colours;
}

std::optional<Similarity> by_surroundings(const Mesh& suspect, const Mesh& original,
                                          std::span<const std::uint64_t> theirs,
                                          Handedness handedness) {
  const std::vector<std::uint64_t> ours = unique_surroundings(suspect, handedness);
  const auto known = unique_points(theirs);
  std::vector<PointPair> pairs;
  for (std::uint32_t point = 0; point < ours.size(); ++point) {
    if (ours[point] == 0) continue;  // nor does a match with an unknown one count
    const auto match = known.find(ours[point]);
    if (match == known.end() || match->second == kSeveral) continue;
    pairs.push_back({suspect.positions[point], original.positions[match->second]});
  }
  return trimmed_similarity(std::move(pairs));
}

// The first moments of a surface by its area.
struct Moments {
  Vec3 centre{0, 0, 0};
  double size = 0;  // root mean square distance from the centre
  PrincipalAxes axes;
};

std::optional<Moments> moments_of(const Mesh& mesh) {
  double area = 0;
  Moments moments;
  const auto for_each = [&](const auto& visit) {
    for (const Triangle& t : mesh.triangles) {
      const Vec3 middle = (mesh.positions[t[0]] + mesh.positions[t[1]] + mesh.positions[t[2]]) / 3;
      visit(middle, area_normal(mesh.positions, t).norm());
    }
  };
  for_each([&](const Vec3& middle, double weight) {
    area += weight;
    moments.centre += middle * weight;
  });
  if (!(area > 0)) return std::nullopt;
  moments.centre = moments.centre / area;
  SymmetricMatrix spread;
  for_each([&](const Vec3& middle, double weight) {
    spread.add(middle - moments.centre, weight / area);
  });
  moments.size = std::sqrt(spread.trace());
  if (!(moments.size > 0)) return std::nullopt;
  moments.axes = spread.principal_axes();
  return moments;
}

// Returns the ways in which the principal axes can be brought to each other, by their order.
std::vector<Similarity> by_axes(const Mesh& suspect, const Mesh& original) {
  const auto ours = moments_of(suspect);
  const auto theirs = moments_of(original);
  std::vector<Similarity> ways;
  if (!ours || !theirs) return ways;
  for (unsigned signs = 0; signs < 8; ++signs) {
    Similarity way;
    way.scale = theirs->size / ours->size;
    for (std::size_t row = 0; row < 3; ++row) {
      Vec3 sum(0, 0, 0);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double sign = (signs >> axis & 1U) != 0 ? -1 : 1;
        sum += ours->axes.axes[axis] * (sign * theirs->axes.axes[axis][row]);
      }
      way.rows[row] = sum;
    }
    way.shift = Vec3(0, 0, 0);
    way.shift = theirs->centre - way(ours->centre);
    ways.push_back(way);
  }
  return ways;
}

// How points of the suspect lie to the original.
class Judgement {
 public:
  Judgement(const Mesh& suspect, const Mesh& original)
      : original_(original),
        index_(original.positions, original.triangles),
        diagonal_(bounding_box(original.positions).size().norm()),
        judges_(some_points(suspect.positions, kJudges)),
        pullers_(some_points(suspect.positions, kPullers)) {}

  [[nodiscard]] double diagonal() const { return diagonal_; }

  [[nodiscard]] Alignment judged(const Similarity& motion) const {
    std::vector<double> distances(judges_.size());
    parallel_for(judges_.size(), [&](std::size_t i) {
      const ClosestPoint closest = index_.closest(motion(judges_[i]), kClose * diagonal_);
      distances[i] = closest.triangle == kNoTriangle ? -1 : closest.distance;
    });
    Alignment result{motion, 0, 0};
    double count = 0;
    for (const double distance : distances) {
      if (distance < 0) continue;
      ++count;
      result.rms += distance * distance;
    }
    result.overlap = count / static_cast<double>(judges_.size());
    result.rms = count > 0 ? std::sqrt(result.rms / count) : 0;
    return result;
  }

  // Returns how far apart the points are that two motions bring the suspect to, at most.
  [[nodiscard]] double differ(const Similarity& a, const Similarity& b) const {
    double most = 0;
    for (const Vec3& point : judges_) most = std::max(most, (a(point) - b(point)).norm());
    return most;
  }

  // Moves the suspect closer until it moves no more.
  [[nodiscard]] Similarity pulled(Similarity motion) const {
    double reach = kFarthestPull * diagonal_;
    for (int pull = 0; pull < kMostPulls; ++pull) {
      stop_point();
      const std::optional<Similarity> next = pulled_once(motion, reach);
      if (!next) return motion;
      const double moved = differ(*next, motion);
      motion = *next;
      reach = std::max(kNearestPull * diagonal_, reach / 1.3);
      if (moved < 1e-8 * diagonal_ && reach == kNearestPull * diagonal_) break;
    }
    return motion;
  }

 private:
  // One step of least squares of the distances from the planes of the closest triangles, linear in
  // a small turn, a shift and a factor of the scale.
  [[nodiscard]] std::optional<Similarity> pulled_once(const Similarity& motion,
                                                      double reach) const {
    using Row = Eigen::Matrix<double, 7, 1>;
    struct Equation {
      Row row = Row::Zero();
      double miss = 0;
      bool counts = false;
    };
    std::vector<Equation> equations(pullers_.size());
    const Box box = bounding_box(original_.positions);
    const Vec3 centre = (box.low + box.high) / 2;
    parallel_for(pullers_.size(), [&](std::size_t i) {
      const Vec3 at = motion(pullers_[i]);
      const ClosestPoint closest = index_.closest(at, reach);
      if (closest.triangle == kNoTriangle) return;
      const Vec3 normal =
          area_normal(original_.positions, original_.triangles[closest.triangle]).normalized();
      if (!std::isfinite(normal.sqrnorm())) return;
      const Vec3 arm = (at - centre) / diagonal_;
      const Vec3 turn = cross(arm, normal);
      equations[i].row << turn[0], turn[1], turn[2], normal[0], normal[1], normal[2],
          dot(arm, normal);
      equations[i].miss = dot(normal, closest.point - at) / diagonal_;
      equations[i].counts = true;
    });
    Eigen::Matrix<double, 7, 7> squares = Eigen::Matrix<double, 7, 7>::Zero();
    Row right = Row::Zero();
    std::size_t count = 0;
    for (const Equation& equation : equations) {
      if (!equation.counts) continue;
      ++count;
      squares += equation.row * equation.row.transpose();
      right += equation.row * equation.miss;
    }
    if (count < kLeastPairs) return std::nullopt;
    // keeps still what the shape leaves free, as a turn of a cylinder
    squares.diagonal().array() += 1e-9 * squares.trace();
    const Row step = squares.ldlt().solve(right);
    const Eigen::Vector3d angle(step[0], step[1], step[2]);
    const Eigen::Matrix3d turn =
        angle.norm() > 0 ? Eigen::AngleAxisd(angle.norm(), angle.normalized()).toRotationMatrix()
                         : Eigen::Matrix3d::Identity();
    const double factor = 1 + step[6];
    if (!(factor > 0) || !turn.allFinite()) return std::nullopt;
    Similarity next;
    next.scale = motion.scale * factor;
    for (std::size_t row = 0; row < 3; ++row) {
      const auto r = static_cast<Eigen::Index>(row);
      next.rows[row] =
          motion.rows[0] * turn(r, 0) + motion.rows[1] * turn(r, 1) + motion.rows[2] * turn(r, 2);
    }
    const Vec3 arm = motion.shift - centre;
    for (std::size_t row = 0; row < 3; ++row) {
      const auto r = static_cast<Eigen::Index>(row);
      next.shift[row] = factor * (turn(r, 0) * arm[0] + turn(r, 1) * arm[1] + turn(r, 2) * arm[2]) +
                        centre[row] + step[static_cast<Eigen::Index>(3 + row)] * diagonal_;
    }
    return next;
  }

  const Mesh& original_;
  SpatialIndex index_;
  double diagonal_;
  std::vector<Vec3> judges_;
  std::vector<Vec3> pullers_;
};

}  // namespace

std::vector<std::uint64_t> landmarks(const Mesh& mesh) {
  return unique_surroundings(mesh, Handedness::Same);
}

namespace {

// `theirs` returns the landmarks of the original, which are not always needed.
template <typename Landmarks>
std::vector<Alignment> aligned_by(const Mesh& suspect, const Mesh& original,
                                  const Landmarks& theirs) {
  if (suspect.positions.empty() || original.triangles.empty()) return {};
  const Judgement judgement(suspect, original);
  if (!(judgement.diagonal() > 0)) return {};
  std::vector<Alignment> ways = {judgement.judged(Similarity())};
  const auto is_sure = [&] {
    return std::any_of(ways.begin(), ways.end(),
                       [](const Alignment& way) { return way.overlap >= kSureOverlap; });
  };
  for (const Handedness handedness : {Handedness::Same, Handedness::Mirrored}) {
    if (is_sure()) break;
    const auto way = by_surroundings(suspect, original, theirs(), handedness);
    if (way) ways.push_back(judgement.judged(*way));
  }
  if (!is_sure()) {
    for (const Similarity& way : by_axes(suspect, original)) {
      ways.push_back(judgement.judged(judgement.pulled(way)));
    }
  }
  std::erase_if(ways, [](const Alignment& way) { return way.overlap < kLeastOverlap; });
  for (Alignment& way : ways) {
    const Alignment closer = judgement.judged(judgement.pulled(way.motion));
    if (closer.overlap >= way.overlap && closer.rms <= way.rms) way = closer;
  }
  std::stable_sort(ways.begin(), ways.end(), [](const Alignment& a, const Alignment& b) {
    return a.overlap != b.overlap ? a.overlap > b.overlap : a.rms < b.rms;
  });
  std::vector<Alignment> best;
  for (const Alignment& way : ways) {
    const bool is_as_good =
        best.empty() || (way.overlap >= kAsGood * best[0].overlap &&
                         way.rms <= best[0].rms / kAsGood + kSameWay * judgement.diagonal());
    const bool is_new = std::none_of(best.begin(), best.end(), [&](const Alignment& other) {
      return judgement.differ(way.motion, other.motion) <= kSameWay * judgement.diagonal();
    });
    if (is_as_good && is_new && best.size() < kMostAlignments) best.push_back(way);
  }
  return best;
}

}  // namespace

std::vector<Alignment> align(const Mesh& suspect, const Mesh& original) {
  return aligned_by(suspect, original, [&] { return landmarks(original); });
}

std::vector<Alignment> align(const Mesh& suspect, const Mesh& original,
                             std::span<const std::uint64_t> marks) {
  return aligned_by(suspect, original, [&] { return marks; });
}

std::vector<std::optional<Vec3>> places_on(const Mesh& original, const Mesh& suspect,
                                           const Similarity& motion, double reach) {
  std::vector<Vec3> moved;
  for (const Vec3& point : suspect.positions) moved.push_back(motion(point));
  const SpatialIndex index(moved, suspect.triangles);
  std::vector<Vec3> normals(original.positions.size(), Vec3(0, 0, 0));
  for (const Triangle& t : original.triangles) {
    const Vec3 normal = area_normal(original.positions, t);
    for (const std::uint32_t point : t) normals[point] += normal;
  }
  std::vector<std::optional<Vec3>> places(original.positions.size());
  parallel_for(
      places.size(),
      [&](std::size_t i) {
        const Vec3& at = original.positions[i];
        const ClosestPoint closest = index.closest(at, reach);
        const double length = normals[i].norm();
        if (closest.triangle == kNoTriangle || !(length > 0)) return;
        const Vec3 normal = normals[i] / length;
        const double offset = dot(normal, closest.point - at);
        // beyond a rim the nearest is not above or below
        const double beside = (closest.point - at - normal * offset).norm();
        if (beside > std::max(std::abs(offset), 0.1 * reach)) return;
        places[i] = at + normal * offset;
      },
      256);
  return places;
}

std::vector<std::optional<Vec3>> nearest_points(const Mesh& original, const Mesh& suspect,
                                                const Similarity& motion, double reach) {
  std::vector<Vec3> moved;
  for (const Vec3& point : suspect.positions) moved.push_back(motion(point));
  std::vector<std::optional<Vec3>> nearest(original.positions.size());
  parallel_for(
      nearest.size(),
      [&](std::size_t i) {
        double least = reach * reach;
        for (const Vec3& point : moved) {
          const double distance = (point - original.positions[i]).sqrnorm();
          if (distance > least) continue;
          least = distance;
          nearest[i] = point;
        }
      },
      64);
  return nearest;
}

std::vector<Similarity> ways_onto(std::span<const Vec3> points, std::span<const Vec3> targets,
                                  std::size_t most) {
  if (targets.size() < 3) return {};
  const double unit = (targets[1] - targets[0]).norm();
  // the ratios of a target's distances from those before it to that of the first two
  const auto fits = [&](const std::vector<std::size_t>& chosen) {
    const std::size_t last = chosen.size() - 1;
    const double own = (points[chosen[1]] - points[chosen[0]]).norm();
    for (std::size_t i = 0; i < last; ++i) {
      const double wanted = (targets[last] - targets[i]).norm() / unit;
      const double seen = (points[chosen[last]] - points[chosen[i]]).norm() / own;
      if (!(std::abs(seen - wanted) <= kSameRatio * std::max(wanted, 1.0))) return false;
    }
    return true;
  };
  std::vector<std::pair<double, Similarity>> ways;
  std::vector<std::size_t> chosen;
  const auto choose = [&](const auto& self) -> void {
    if (chosen.size() == targets.size()) {
      std::vector<PointPair> pairs;
      for (std::size_t i = 0; i < targets.size(); ++i) {
        pairs.push_back({points[chosen[i]], targets[i]});
      }
      const auto way = fitted_similarity(pairs);
      if (!way) return;
      double miss = 0;
      for (const PointPair& pair : pairs) miss += ((*way)(pair.from) - pair.to).sqrnorm();
      ways.emplace_back(miss, *way);
      return;
    }
    stop_point();
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (std::find(chosen.begin(), chosen.end(), i) != chosen.end()) continue;
      chosen.push_back(i);
      if (chosen.size() < 3 || fits(chosen)) self(self);
      chosen.pop_back();
    }
  };
  choose(choose);
  std::stable_sort(ways.begin(), ways.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Similarity> best;
  for (std::size_t i = 0; i < std::min(most, ways.size()); ++i) best.push_back(ways[i].second);
  return best;
}

}  // namespace triglyph
