#include "engine/scheme/iie/iie.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <unordered_map>
#include <unordered_set>

#include "engine/base/error.h"
#include "engine/base/parallel.h"
#include "engine/base/random.h"
#include "engine/geometry/spatial_index.h"
#include "engine/mesh/edge_length.h"
#include "engine/scheme/cost_rows.h"
#include "engine/scheme/iie/ring_signature.h"
#include "engine/scheme/local_cost.h"

namespace triglyph {
namespace {

constexpr double kMargin = 0.02;  // of the radius: what a shift of the centre may bring near
constexpr double kVolumeStep =
    1.3;                            // cells of the volume over those of the area, as their noise is
constexpr double kFlatCap = 0.5;    // of the radius: so far the cap moves as one
constexpr double kMaxShift = 0.25;  // of the radius, of the centre
constexpr double kMaxMove = 0.22;   // of the radius, of a point
constexpr int kSamples = 17;        // of the invariants along a centre's way
constexpr double kSharpness = 4.5;  // a cell's border lies three standard deviations of noise away
constexpr std::size_t kUnitsPerTask = 4;
constexpr int kMaxQuantiserBits = 16;
constexpr int kRadiusRounds = 2;
constexpr int kMaxRefinements = 40;
constexpr double kAreaPrecision = 1e-13;

// Points within so many rings, ascending, the point itself among them; nothing if a fan is open.
std::optional<std::vector<std::uint32_t>> points_within(const Halfedges& halfedges,
                                                        std::uint32_t point, int rings) {
  std::vector<std::uint32_t> found{point};
  std::size_t done = 0;
  for (int ring = 0; ring < rings; ++ring) {
    const std::size_t end = found.size();
    for (; done < end; ++done) {
      const bool closed =
          visit_ring(halfedges, found[done], [&](std::uint32_t other) { found.push_back(other); });
      if (!closed) return std::nullopt;
    }
    std::sort(found.begin() + static_cast<std::ptrdiff_t>(end), found.end());
    found.erase(std::unique(found.begin() + static_cast<std::ptrdiff_t>(end), found.end()),
                found.end());
    // drop what earlier rings have
    std::vector<std::uint32_t> known(found.begin(),
                                     found.begin() + static_cast<std::ptrdiff_t>(end));
    std::sort(known.begin(), known.end());
    found.erase(std::remove_if(found.begin() + static_cast<std::ptrdiff_t>(end), found.end(),
                               [&](std::uint32_t p) {
                                 return std::binary_search(known.begin(), known.end(), p);
                               }),
                found.end());
  }
  std::sort(found.begin(), found.end());
  return found;
}

// A regular mesh has about 7 (r / e)^2 triangles in a ball; where there are far more, points lie in
// heaps, and to look at all of them from all of them would take for ever.
std::size_t most_triangles_in(double radius, double edge) {
  constexpr double kCrowd = 100;
  const double share = edge > 0 ? radius / edge : 0;
  return static_cast<std::size_t>(std::min(kCrowd * share * share, 1e9));
}

// Falls smoothly from 1 within kFlatCap of the radius to 0 at the radius.
double cap_profile(double distance, double radius) {
  const double s = std::max(0.0, (distance / radius - kFlatCap) / (1 - kFlatCap));
  return s < 1 ? (1 - s * s) * (1 - s * s) : 0;
}

// Area vectors of the triangles around a point, added up.
Vec3 fan_area(const Surface& surface, std::uint32_t point) {
  const Vec3& apex = surface.mesh.positions[point];
  Vec3 sum(0, 0, 0), first(0, 0, 0), last(0, 0, 0);
  bool started = false;
  visit_ring(surface.halfedges, point, [&](std::uint32_t other) {
    const Vec3 arm = surface.mesh.positions[other] - apex;
    if (started) sum += cross(last, arm);
    if (!started) first = arm;
    started = true;
    last = arm;
  });
  return (sum + cross(last, first)) * 0.5;
}

// Of the readings within `distance` of a better one none stays. Ascending by anchor before and
// after.
std::vector<Reading> keep_best_apart(std::vector<Reading> readings, std::span<const Vec3> places,
                                     double distance) {
  std::vector<std::uint32_t> order(readings.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return readings[a].weight != readings[b].weight ? readings[a].weight > readings[b].weight
                                                    : a < b;
  });
  using Cell = std::array<std::int64_t, 3>;
  const auto cell_of = [&](const Vec3& p) {
    return Cell{static_cast<std::int64_t>(std::floor(p[0] / distance)),
                static_cast<std::int64_t>(std::floor(p[1] / distance)),
                static_cast<std::int64_t>(std::floor(p[2] / distance))};
  };
  const auto hash = [](const Cell& cell) {
    return random_bits(static_cast<std::uint64_t>(cell[0]), static_cast<std::uint64_t>(cell[1]),
                       static_cast<std::uint64_t>(cell[2]));
  };
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> kept;
  std::vector<char> stays(readings.size(), 0);
  for (const std::uint32_t i : order) {
    const Cell cell = cell_of(places[i]);
    bool free = true;
    for (std::int64_t n = 0; n < 27 && free; ++n) {
      const auto found =
          kept.find(hash({cell[0] + n % 3 - 1, cell[1] + n / 3 % 3 - 1, cell[2] + n / 9 - 1}));
      if (found == kept.end()) continue;
      free = std::none_of(found->second.begin(), found->second.end(), [&](std::uint32_t other) {
        return (places[i] - places[other]).sqrnorm() < distance * distance;
      });
    }
    if (!free) continue;
    stays[i] = 1;
    kept[hash(cell)].push_back(i);
  }
  std::vector<Reading> best;
  for (std::size_t i = 0; i < readings.size(); ++i) {
    if (stays[i] != 0) best.push_back(readings[i]);
  }
  return best;
}

}  // namespace

struct IieScheme::Ground {
  const Surface& surface;
  double radius;       // of the balls
  double read_radius;  // with which the marked mesh will be read
  int centre_rings;
  std::size_t most_triangles;  // of a ball
  SpatialIndex index;
  std::vector<char> unfit;           // triangles at a boundary
  std::vector<std::uint32_t> sites;  // points that may be centres, ascending

  Ground(const Surface& on, const SchemeOptions& options, std::uint64_t seed)
      : surface(on),
        radius(fixed_for(on.mesh, options).radius),
        read_radius(radius),
        centre_rings(options.centre_rings),
        most_triangles(most_triangles_in(radius, mean_edge_length(on.mesh))),
        index(on.mesh.positions, on.mesh.triangles),
        unfit(on.mesh.triangles.size(), 0) {
    const Halfedges& halfedges = surface.halfedges;
    for (std::uint32_t t = 0; t < unfit.size(); ++t) {
      Halfedge side = halfedges.first_of_face(t);
      for (int i = 0; i < 3; ++i) {
        if (halfedges.is_boundary(halfedges.opposite(side))) unfit[t] = 1;
        side = halfedges.next(side);
      }
    }
    find_sites(options.site_rings, seed);
  }

  void find_sites(int rings, std::uint64_t seed) {
    const std::size_t points = surface.mesh.positions.size();
    const auto signatures = ring_signatures(surface.halfedges, points, seed);
    sites = parallel_collect<std::uint32_t>(
        points, [&](std::size_t i, std::vector<std::uint32_t>& out) {
          const auto point = static_cast<std::uint32_t>(i);
          if (signatures[point] == 0) return;
          const auto beats_all_within = [&](int so_many) {
            const auto near = points_within(surface.halfedges, point, so_many);
            return near && std::all_of(near->begin(), near->end(), [&](std::uint32_t other) {
                     return signatures[other] <= signatures[point];
                   });
          };
          // nearly all points fail already against their neighbours
          if (beats_all_within(std::min(rings, 1)) && beats_all_within(rings)) out.push_back(point);
        });
  }

  [[nodiscard]] std::optional<Vec3> centre_at(std::uint32_t anchor) const {
    const auto points = points_within(surface.halfedges, anchor, centre_rings);
    if (!points) return std::nullopt;
    return mean_of(*points);
  }

  [[nodiscard]] Vec3 mean_of(std::span<const std::uint32_t> points) const {
    Vec3 sum(0, 0, 0);
    for (const std::uint32_t point : points) sum += surface.mesh.positions[point];
    return sum / static_cast<double>(points.size());
  }

  [[nodiscard]] bool sample(Ball& ball) const;
  [[nodiscard]] BallInvariants invariants(std::span<const std::uint32_t> near,
                                          const Vec3& centre) const {
    return ball_invariants(surface.mesh.positions, surface.mesh.triangles, near, centre,
                           read_radius);
  }
};

struct IieScheme::Ball {
  Vec3 centre{0, 0, 0};
  Vec3 normal{0, 0, 0};
  double radius = 0;
  std::vector<std::uint32_t> near;  // triangles that the ball meets or nearly meets
  std::vector<std::uint32_t> cap;   // points to be moved
  std::vector<double> profile;      // of the cap's points
  std::vector<char> is_centres;     // does the centre depend on the point?
  double centre_gain = 0;           // shift of the centre for a move of the whole cap
  double lift_all = 0;              // change of the volume share for a move of the whole cap, a
  double lift_outer = 0;            // model unit; or of all but the centre's points
  std::array<BallInvariants, kSamples> samples{};  // along the normal, the cap unmoved

  [[nodiscard]] static double shift_of(int sample, double radius) {
    return kMaxShift * radius * (2.0 * sample / (kSamples - 1) - 1);
  }
  [[nodiscard]] BallInvariants at(double shift) const {
    const double place = (shift / (kMaxShift * radius) + 1) / 2 * (kSamples - 1);
    const auto below = static_cast<std::size_t>(std::clamp(place, 0.0, kSamples - 1.001));
    const double t = place - static_cast<double>(below);
    const BallInvariants& a = samples[below];
    const BallInvariants& b = samples[below + 1];
    return {a.area + t * (b.area - a.area), a.volume + t * (b.volume - a.volume)};
  }
  [[nodiscard]] double move_of(std::size_t i, const Moves& moves) const {
    return profile[i] * (moves.all + (is_centres[i] != 0 ? 0 : moves.outer));
  }

  double most_inner = 0, most_outer = 0;        // of the profile, centre's points and others
  double squares_inner = 0, squares_outer = 0;  // sums of its squares
  [[nodiscard]] double farthest(const Moves& moves) const {
    return std::max(most_inner * std::abs(moves.all),
                    most_outer * std::abs(moves.all + moves.outer));
  }
  [[nodiscard]] double rms(const Moves& moves) const {
    const double outer = moves.all + moves.outer;
    return std::sqrt((squares_inner * moves.all * moves.all + squares_outer * outer * outer) /
                     static_cast<double>(cap.size()));
  }
};

// False where too many triangles lie about the centre.
bool IieScheme::Ground::sample(Ball& ball) const {
  auto near =
      index.triangles_in_ball(ball.centre, ball.radius * (1 + kMaxShift), 2 * most_triangles);
  if (!near) return false;
  ball.near = std::move(*near);
  for (int i = 0; i < kSamples; ++i) {
    const Vec3 centre = ball.centre + ball.normal * Ball::shift_of(i, ball.radius);
    ball.samples[static_cast<std::size_t>(i)] = invariants(ball.near, centre);
  }
  return true;
}

IieScheme::IieScheme(const WordCode& code, const SchemeOptions& options)
    : options_(options),
      marker_(code.marker()),
      marker_bits_(code.format().marker_bits),
      area_(options.step,
            std::min(code.format().marker_bits + code.format().subscript_bits, kMaxQuantiserBits),
            code.offset(0)),
      volume_(options.step * kVolumeStep, std::min(code.format().part_bits, kMaxQuantiserBits),
              code.offset(1)),
      site_seed_(std::bit_cast<std::uint64_t>(code.offset(2))) {
  const WordFormat& format = code.format();
  const auto refuse = [](const char* what) { throw Error(ErrorCode::Usage, {}, "", what); };
  if (format.marker_bits + format.subscript_bits > kMaxQuantiserBits ||
      format.part_bits > kMaxQuantiserBits) {
    refuse("iie holds 16 bits of marker and subscript, and 16 of the part");
  }
  if (!(options.step > 0 && options.step <= 0.25)) {
    refuse("the cell width of iie lies above 0 and up to 0.25");
  }
  if (!(options.radius_edges >= 2 && options.radius_edges <= 100)) {
    refuse("the radius of iie is 2 to 100 mean edges");
  }
  if (options.centre_rings < 1 || options.centre_rings > 3) {
    refuse("the centres of iie are means over 1 to 3 rings");
  }
  if (!(options.radius >= 0) || options.site_rings < 0 || options.site_rings > 8) {
    refuse("iie wants a radius of at least 0 and 0 to 8 rings between sites");
  }
}

// Points reached from the anchor whose triangles all lie well within the ball, ascending.
std::vector<std::uint32_t> IieScheme::cap_of(const Ground& ground, std::uint32_t anchor,
                                             const Vec3& centre) {
  const Surface& surface = ground.surface;
  const double inside = ground.radius * (1 - kMargin);
  const auto lies_inside = [&](std::uint32_t point) {
    return (surface.mesh.positions[point] - centre).sqrnorm() < inside * inside;
  };
  std::vector<std::uint32_t> cap;
  std::unordered_set<std::uint32_t> seen{anchor};
  std::vector<std::uint32_t> queue{anchor};
  for (std::size_t next = 0; next < queue.size(); ++next) {
    std::vector<std::uint32_t> ring;
    const bool closed = visit_ring(surface.halfedges, queue[next],
                                   [&](std::uint32_t other) { ring.push_back(other); });
    if (!closed || !std::all_of(ring.begin(), ring.end(), lies_inside)) continue;
    cap.push_back(queue[next]);
    for (const std::uint32_t other : ring) {
      if (seen.insert(other).second) queue.push_back(other);
    }
  }
  std::sort(cap.begin(), cap.end());
  return cap;
}

// How far each point of the cap follows a move, and what that does to centre and volume.
void IieScheme::weigh_cap(const Ground& ground, std::span<const std::uint32_t> centre_points,
                          Ball& ball) {
  const double volume = 4.0 / 3.0 * std::numbers::pi * std::pow(ground.read_radius, 3);
  for (const std::uint32_t point : ball.cap) {
    const double distance = (ground.surface.mesh.positions[point] - ball.centre).norm();
    const double profile = cap_profile(distance, ground.radius);
    const bool is_centres = std::binary_search(centre_points.begin(), centre_points.end(), point);
    const double lift = profile * dot(fan_area(ground.surface, point), ball.normal) / (3 * volume);
    ball.profile.push_back(profile);
    ball.is_centres.push_back(is_centres ? 1 : 0);
    ball.lift_all += lift;
    (is_centres ? ball.squares_inner : ball.squares_outer) += profile * profile;
    double& most = is_centres ? ball.most_inner : ball.most_outer;
    most = std::max(most, profile);
    if (is_centres) {
      ball.centre_gain += profile / static_cast<double>(centre_points.size());
    } else {
      ball.lift_outer += lift;
    }
  }
}

std::optional<IieScheme::Ball> IieScheme::ball_at(const Ground& ground,
                                                  std::uint32_t anchor) const {
  const auto centre_points = points_within(ground.surface.halfedges, anchor, options_.centre_rings);
  if (!centre_points) return std::nullopt;
  Ball ball;
  ball.radius = ground.radius;
  ball.centre = ground.mean_of(*centre_points);
  for (const std::uint32_t point : *centre_points) ball.normal += fan_area(ground.surface, point);
  const double length = ball.normal.norm();
  if (!(length > 0)) return std::nullopt;
  ball.normal /= length;

  auto near = ground.index.triangles_in_ball(ball.centre, ground.radius * (1 + kMargin),
                                             ground.most_triangles);
  if (!near) return std::nullopt;
  ball.near = std::move(*near);
  const bool at_boundary = std::any_of(ball.near.begin(), ball.near.end(),
                                       [&](std::uint32_t t) { return ground.unfit[t] != 0; });
  if (at_boundary) return std::nullopt;

  ball.cap = cap_of(ground, anchor, ball.centre);
  if (!std::includes(ball.cap.begin(), ball.cap.end(), centre_points->begin(),
                     centre_points->end())) {
    return std::nullopt;
  }
  weigh_cap(ground, *centre_points, ball);
  if (!(ball.lift_outer > 0 && ball.lift_all > 0)) return std::nullopt;  // too crumpled
  return ball;
}

// Where the centre must go for this area, as near as can be; by the samples.
std::optional<double> IieScheme::centre_shift(const Ball& ball, double area) const {
  constexpr int kMiddle = (kSamples - 1) / 2;
  for (int away = 0; away < kMiddle; ++away) {
    for (const int first : {kMiddle + away, kMiddle - away - 1}) {
      const auto at = static_cast<std::size_t>(first);
      const double here = ball.samples[at].area - area;
      const double there = ball.samples[at + 1].area - area;
      if (here * there > 0 || here == there) continue;
      const double from = Ball::shift_of(first, ball.radius);
      const double to = Ball::shift_of(first + 1, ball.radius);
      return from + (to - from) * here / (here - there);
    }
  }
  return std::nullopt;
}

// The moves that bring the volume to this share, the centre being where it is and the volume with
// the cap unmoved being known.
IieScheme::Moves IieScheme::moves_to(const Ball& ball, double shift, double volume, double wanted) {
  Moves moves;
  moves.all = shift / ball.centre_gain;
  moves.outer = (wanted - volume - moves.all * ball.lift_all) / ball.lift_outer;
  return moves;
}

std::optional<IieScheme::Plan> IieScheme::plan(const Ball& ball, const Word& word) const {
  std::optional<Plan> best;
  double best_move = kMaxMove * ball.radius;
  const double area = ball.at(0).area;
  const double near_area = area_.nearest_centre(area, area_bits(word));
  for (const double wanted_area : {near_area, area_.second_centre(area, near_area)}) {
    const std::optional<double> shift = centre_shift(ball, wanted_area);
    if (!shift) continue;
    const double volume = ball.at(*shift).volume;
    const double lifted = volume + *shift / ball.centre_gain * ball.lift_all;
    const double near_volume = volume_.nearest_centre(lifted, word.part);
    for (const double wanted : {near_volume, volume_.second_centre(lifted, near_volume)}) {
      const Moves moves = moves_to(ball, *shift, volume, wanted);
      if (!(ball.farthest(moves) < best_move)) continue;
      best_move = ball.farthest(moves);
      best = Plan{wanted_area, wanted, *shift, moves};
    }
  }
  return best;
}

// From the samples' answer to the exact one: regula falsi (Illinois) about the planned shift.
std::optional<IieScheme::Moves> IieScheme::refine(const Ground& ground, const Ball& ball,
                                                  const Plan& plan) {
  const auto excess = [&](double shift) {
    return ground.invariants(ball.near, ball.centre + ball.normal * shift).area - plan.area;
  };
  const double spacing = 2 * kMaxShift * ball.radius / (kSamples - 1);
  double low = plan.shift - spacing, high = plan.shift + spacing;
  double at_low = excess(low), at_high = excess(high);
  if (at_low * at_high > 0) return std::nullopt;
  double shift = plan.shift;
  int same_side = 0;
  for (int step = 0; step < kMaxRefinements; ++step) {
    const double value = excess(shift);
    if (std::abs(value) < kAreaPrecision) break;
    const bool replaces_low = value * at_high < 0;
    (replaces_low ? low : high) = shift;
    (replaces_low ? at_low : at_high) = value;
    same_side = replaces_low ? std::max(1, same_side + 1) : std::min(-1, same_side - 1);
    if (same_side > 1) at_high /= 2;
    if (same_side < -1) at_low /= 2;
    shift = (low * at_high - high * at_low) / (at_high - at_low);
  }
  const double volume = ground.invariants(ball.near, ball.centre + ball.normal * shift).volume;
  return moves_to(ball, shift, volume, plan.volume);
}

UnitSet IieScheme::find_units(const Surface& surface) const {
  const Ground ground(surface, options_, site_seed_);
  struct Found {
    std::uint32_t anchor;
    std::vector<std::uint32_t> moved, read;
  };
  std::vector<Found> found(ground.sites.size());
  parallel_for(
      ground.sites.size(),
      [&](std::size_t i) {
        std::optional<Ball> ball = ball_at(ground, ground.sites[i]);
        if (!ball) return;
        std::vector<std::uint32_t> read = ball->cap;
        for (const std::uint32_t triangle : ball->near) {
          const Triangle& corners = surface.mesh.triangles[triangle];
          read.insert(read.end(), corners.begin(), corners.end());
        }
        std::sort(read.begin(), read.end());
        read.erase(std::unique(read.begin(), read.end()), read.end());
        found[i] = {ground.sites[i], std::move(ball->cap), std::move(read)};
      },
      kUnitsPerTask);
  UnitSet units;
  for (const Found& unit : found) {
    if (unit.moved.empty()) continue;
    units.anchors.push_back(unit.anchor);
    units.moved.append(unit.moved);
    units.read.append(unit.read);
  }
  return units;
}

CostMatrix IieScheme::costs(const Surface& surface, const UnitSet& units,
                            std::span<const std::uint32_t> chosen,
                            std::span<const Word> words) const {
  const Ground ground(surface, options_, site_seed_);
  const LocalCost local(surface, options_.cost);
  return fill_cost_rows(chosen.size(), words.size(), [&](std::size_t row, std::span<float> costs) {
    std::optional<Ball> ball = ball_at(ground, units.anchors[chosen[row]]);
    if (!ball || !ground.sample(*ball)) return;
    for (std::size_t word = 0; word < costs.size(); ++word) {
      const std::optional<Plan> planned = plan(*ball, words[word]);
      if (planned) costs[word] = cost_of(surface.mesh, local, *ball, planned->moves);
    }
  });
}

float IieScheme::cost_of(const Mesh& mesh, const LocalCost& local, const Ball& ball,
                         const Moves& moves) const {
  if (options_.cost == CostFunction::Displacement) return static_cast<float>(ball.farthest(moves));
  if (options_.cost == CostFunction::Rms) return static_cast<float>(ball.rms(moves));
  std::vector<Move> cap;
  for (std::size_t i = 0; i < ball.cap.size(); ++i) {
    const std::uint32_t point = ball.cap[i];
    cap.push_back({point, mesh.positions[point] + ball.normal * ball.move_of(i, moves)});
  }
  return local.of_part(cap);
}

Embedding IieScheme::embed(const Surface& surface, const UnitSet& units,
                           std::span<const Placement> placements,
                           std::span<const Word> words) const {
  Ground ground(surface, options_, site_seed_);
  Embedding embedding = embed_on(ground, units, placements, words);
  if (options_.radius > 0) return embedding;
  // the mark changes the mean edge length a little, and with it the radius it will be read with
  for (int round = 0; round < kRadiusRounds; ++round) {
    ground.read_radius = fixed_for({embedding.positions, surface.mesh.triangles}, options_).radius;
    embedding = embed_on(ground, units, placements, words);
  }
  return embedding;
}

Embedding IieScheme::embed_on(const Ground& ground, const UnitSet& units,
                              std::span<const Placement> placements,
                              std::span<const Word> words) const {
  Embedding embedding{ground.surface.mesh.positions, {}};
  const auto embed_unit = [&](const Placement& placement) {
    std::optional<Ball> ball = ball_at(ground, units.anchors[placement.unit]);
    if (!ball || !ground.sample(*ball)) return false;
    const std::optional<Plan> planned = plan(*ball, words[placement.word]);
    if (!planned) return false;
    const std::optional<Moves> moves = refine(ground, *ball, *planned);
    if (!moves) return false;
    for (std::size_t i = 0; i < ball->cap.size(); ++i) {
      embedding.positions[ball->cap[i]] += ball->normal * ball->move_of(i, *moves);
    }
    return true;
  };
  std::vector<char> placed(placements.size());
  parallel_for(
      placements.size(), [&](std::size_t i) { placed[i] = embed_unit(placements[i]) ? 1 : 0; },
      kUnitsPerTask);
  for (std::uint32_t i = 0; i < placements.size(); ++i) {
    if (placed[i] == 0) embedding.failed.push_back(i);
  }
  return embedding;
}

std::vector<Reading> IieScheme::read(const Surface& surface) const {
  const Ground ground(surface, options_, site_seed_);
  std::vector<Vec3> centres(ground.sites.size());
  parallel_for(
      centres.size(),
      [&](std::size_t i) { centres[i] = ground.centre_at(ground.sites[i]).value(); },
      kUnitsPerTask);
  const std::vector<BallInvariants> invariants =
      all_ball_invariants(surface.mesh.positions, surface.mesh.triangles, ground.unfit, centres,
                          ground.radius, ground.most_triangles);
  const std::uint32_t marker_mask = (1U << marker_bits_) - 1;
  std::vector<Reading> readings;
  std::vector<Vec3> places;
  for (std::size_t i = 0; i < centres.size(); ++i) {
    const Quantiser::Cell area = area_.cell_of(invariants[i].area);
    const Quantiser::Cell volume = volume_.cell_of(invariants[i].volume);
    const bool crosses = invariants[i].area > 0 && invariants[i].area < 1;  // false for a NaN
    if (!crosses || (area.bits & marker_mask) != marker_) continue;
    const float squared = area.distance * area.distance + volume.distance * volume.distance;
    Reading reading;
    reading.anchor = ground.sites[i];
    reading.word = {area.bits >> marker_bits_, volume.bits};
    reading.worst_offset = std::max(area.distance, volume.distance);
    reading.weight = static_cast<float>(std::exp(-kSharpness * double{squared}));
    reading.bit_weights.fill(1);
    readings.push_back(reading);
    places.push_back(centres[i]);
  }
  return keep_best_apart(std::move(readings), places, ground.radius);
}

// The points within the ball; where that is no ball any more, those of its centre.
PointLists IieScheme::points_of(const Surface& surface,
                                std::span<const std::uint32_t> anchors) const {
  const Ground ground(surface, options_, site_seed_);
  PointLists lists;
  for (const std::uint32_t anchor : anchors) {
    std::vector<std::uint32_t> points;
    if (anchor < surface.mesh.positions.size()) {
      points = points_within(surface.halfedges, anchor, options_.centre_rings)
                   .value_or(std::vector<std::uint32_t>{anchor});
      const auto near = ground.index.triangles_in_ball(ground.mean_of(points), ground.radius,
                                                       ground.most_triangles);
      for (const std::uint32_t triangle : near.value_or(std::vector<std::uint32_t>{})) {
        const Triangle& corners = surface.mesh.triangles[triangle];
        points.insert(points.end(), corners.begin(), corners.end());
      }
    }
    std::sort(points.begin(), points.end());
    points.erase(std::unique(points.begin(), points.end()), points.end());
    lists.append(points);
  }
  return lists;
}

}  // namespace triglyph
