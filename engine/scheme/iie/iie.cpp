#include "engine/scheme/iie/iie.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <mutex>
#include <unordered_map>

#include "engine/base/error.h"
#include "engine/base/once.h"
#include "engine/base/parallel.h"
#include "engine/base/random.h"
#include "engine/geometry/spatial_index.h"
#include "engine/mesh/edge_length.h"
#include "engine/scheme/cost_rows.h"
#include "engine/scheme/iie/sites.h"
#include "engine/scheme/surface_binding.h"

namespace triglyph {
namespace {

// Cells of the volume over those of the area, as their noise is.
constexpr double kVolumeStep = 1.3;
// Of the radius, of a point: there the flank of the cap rises by 34 degrees.
constexpr double kMaxMoveInRadii = 0.22;
// A cell's border lies three standard deviations of noise away: 3^2 / 2.
constexpr double kSharpness = 4.5;
constexpr std::size_t kUnitsPerTask = 4;  // balls are dear, and some far dearer than others
constexpr int kMaxQuantiserBits = 16;     // of Quantiser
// The mark changes the mean edge length so little that two rounds settle the radius.
constexpr int kRadiusRounds = 2;
// Balls kept from costs to embed, at some 2 kB each: 130 MB at most.
constexpr std::size_t kMaxKept = std::size_t{1} << 16;

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

// The scheme on one surface.
class IieScheme::Bound final : public SurfaceBinding {
 public:
  // `sites` of the surface's connectivity.
  Bound(const IieScheme& scheme, const Surface& surface, std::shared_ptr<const IieSites> sites)
      : SurfaceBinding(surface, scheme.options_),
        scheme_(scheme),
        sites_(std::move(sites)),
        edge_(mean_edge_length(surface.mesh)),
        radius_(scheme.options_.radius > 0 ? scheme.options_.radius
                                           : scheme.options_.radius_edges * edge_),
        index_(surface.mesh.positions, surface.mesh.triangles),
        ground_{this->surface(),
                index_,
                sites_->at_boundary,
                radius_,
                scheme.options_.centre_rings,
                most_triangles_in(radius_, edge_)} {}

  [[nodiscard]] UnitSet find_units() const override;
  [[nodiscard]] CostMatrix costs(const UnitSet& units, std::span<const std::uint32_t> chosen,
                                 std::span<const Word> words) const override;
  [[nodiscard]] Embedding embed(const UnitSet& units, std::span<const Placement> placements,
                                std::span<const Word> words) const override;
  [[nodiscard]] std::vector<Reading> read() const override {
    return readings_of(own_sites(), Inside::AsIs);
  }
  [[nodiscard]] std::vector<std::vector<Reading>> read_turned_over() const override;
  [[nodiscard]] std::vector<Reading> read_at(std::span<const std::uint32_t> anchors) const override;
  [[nodiscard]] PointLists points_of(std::span<const std::uint32_t> anchors) const override;
  [[nodiscard]] std::unique_ptr<BoundScheme> moved_to(const Surface& moved) const override {
    return std::make_unique<Bound>(scheme_, moved, sites_);
  }

 private:
  // Is the inside of the surface read as inside, or, where its triangles were turned over or its
  // shape was mirrored, the outside?
  enum class Inside { AsIs, Outside };
  // Places that may carry units, and what their balls show.
  struct Places {
    std::vector<std::uint32_t> points;
    std::vector<Vec3> centres;
    std::vector<BallInvariants> invariants;
  };

  using Balls = std::vector<std::optional<SampledBall>>;
  using KeptBalls = std::unordered_map<std::uint32_t, SampledBall>;  // by anchor

  [[nodiscard]] std::shared_ptr<const KeptBalls> kept() const {
    const std::lock_guard lock(kept_mutex_);
    return kept_;
  }
  void keep(const UnitSet& units, std::span<const std::uint32_t> chosen, Balls balls) const;
  [[nodiscard]] Balls balls_of(const UnitSet& units, std::span<const Placement> placements) const;
  [[nodiscard]] Embedding embed_in(Balls& balls, double read_radius,
                                   std::span<const Placement> placements,
                                   std::span<const Word> words) const;
  [[nodiscard]] std::optional<CapMoves> exact_moves(SampledBall& sampled, const Word& word) const;
  [[nodiscard]] Places places_at(std::vector<std::uint32_t> points) const;
  // The places that marking uses too.
  [[nodiscard]] const Places& own_sites() const {
    return own_sites_.get([&] { return places_at(sites_->points); });
  }
  [[nodiscard]] std::vector<Reading> readings_of(const Places& places, Inside inside) const;

  const IieScheme& scheme_;
  std::shared_ptr<const IieSites> sites_;
  double edge_;  // mean length
  double radius_;
  SpatialIndex index_;
  BallGround ground_;
  Once<Places> own_sites_;
  mutable std::mutex kept_mutex_;
  mutable std::shared_ptr<const KeptBalls> kept_ = std::make_shared<KeptBalls>();
};

IieScheme::IieScheme(const WordCode& code, const IieOptions& options)
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
  if (format.marker_bits + format.subscript_bits > kMaxQuantiserBits ||
      format.part_bits > kMaxQuantiserBits) {
    throw Error(ErrorCode::Usage, {}, "",
                "iie holds 16 bits of marker and subscript, and 16 of the part");
  }
  options.check();
}

std::unique_ptr<BoundScheme> IieScheme::bind(const Surface& surface) const {
  return std::make_unique<Bound>(
      *this, surface,
      std::make_shared<IieSites>(find_sites(surface.halfedges, surface.mesh.positions.size(),
                                            options_.site_rings, site_seed_)));
}

std::optional<IieScheme::Plan> IieScheme::plan(SampledBall& sampled, const Word& word) const {
  const Ball& ball = sampled.ball();
  std::optional<Plan> best;
  double best_move = kMaxMoveInRadii * ball.radius;
  const double area = sampled.interpolated(0).area;
  const double near_area = area_.nearest_centre(area, area_bits(word));
  for (const double wanted_area : {near_area, area_.second_centre(area, near_area)}) {
    const std::optional<double> shift = sampled.shift_for_area(wanted_area);
    if (!shift) continue;
    const double volume = sampled.interpolated(*shift).volume;
    const double lifted = volume + *shift / ball.centre_gain * ball.lift_all;
    const double near_volume = volume_.nearest_centre(lifted, word.part);
    for (const double wanted : {near_volume, volume_.second_centre(lifted, near_volume)}) {
      const CapMoves moves = sampled.moves_to(*shift, volume, wanted);
      if (!(ball.farthest(moves) < best_move)) continue;
      best_move = ball.farthest(moves);
      best = Plan{wanted_area, wanted, *shift, moves};
    }
  }
  return best;
}

float IieScheme::cost_of(const Mesh& mesh, const LocalCost& local, const Ball& ball,
                         const CapMoves& moves) const {
  if (options_.cost == CostFunction::Displacement) return static_cast<float>(ball.farthest(moves));
  if (options_.cost == CostFunction::Rms) return static_cast<float>(ball.rms(moves));
  std::vector<Move> cap;
  for (std::size_t i = 0; i < ball.cap.size(); ++i) {
    const std::uint32_t point = ball.cap[i];
    cap.push_back({point, mesh.positions[point] + ball.normal * ball.move_of(i, moves)});
  }
  return local.of_part(cap);
}

UnitSet IieScheme::Bound::find_units() const {
  std::vector<SiteUnit> found(sites_->points.size());
  parallel_for(
      found.size(),
      [&](std::size_t i) {
        std::optional<Ball> ball = ball_at(ground_, sites_->points[i]);
        if (!ball) return;
        std::vector<std::uint32_t> read = ball->cap;
        for (const std::uint32_t triangle : ball->near) {
          const Triangle& corners = mesh().triangles[triangle];
          read.insert(read.end(), corners.begin(), corners.end());
        }
        std::sort(read.begin(), read.end());
        read.erase(std::unique(read.begin(), read.end()), read.end());
        found[i] = {std::move(ball->cap), std::move(read)};
      },
      kUnitsPerTask);
  return units_at(*sites_, found);
}

CostMatrix IieScheme::Bound::costs(const UnitSet& units, std::span<const std::uint32_t> chosen,
                                   std::span<const Word> words) const {
  const LocalCost& local = local_cost();
  const bool keeps = chosen.size() <= kMaxKept;
  Balls balls(keeps ? chosen.size() : 0);
  CostMatrix matrix =
      fill_cost_rows(chosen.size(), words.size(), [&](std::size_t row, std::span<float> costs) {
        std::optional<SampledBall> sampled = SampledBall::at(ground_, units.anchors[chosen[row]]);
        if (!sampled) return;
        for (std::size_t word = 0; word < costs.size(); ++word) {
          const std::optional<Plan> planned = scheme_.plan(*sampled, words[word]);
          if (!planned) continue;
          costs[word] = scheme_.cost_of(mesh(), local, sampled->ball(), planned->moves);
        }
        if (keeps) balls[row] = std::move(sampled);
      });
  if (keeps) keep(units, chosen, std::move(balls));
  return matrix;
}

// In place of those of an earlier call: layout has chosen the units that will be embedded.
void IieScheme::Bound::keep(const UnitSet& units, std::span<const std::uint32_t> chosen,
                            Balls balls) const {
  auto kept = std::make_shared<KeptBalls>();
  kept->reserve(balls.size());
  for (std::size_t row = 0; row < balls.size(); ++row) {
    if (balls[row]) kept->emplace(units.anchors[chosen[row]], std::move(*balls[row]));
  }
  const std::lock_guard lock(kept_mutex_);
  kept_ = std::move(kept);
}

IieScheme::Bound::Balls IieScheme::Bound::balls_of(const UnitSet& units,
                                                   std::span<const Placement> placements) const {
  const std::shared_ptr<const KeptBalls> known = kept();
  Balls balls(placements.size());
  parallel_for(
      placements.size(),
      [&](std::size_t i) {
        const std::uint32_t anchor = units.anchors[placements[i].unit];
        const auto at = known->find(anchor);
        if (at != known->end()) {
          balls[i] = at->second;
        } else {
          balls[i] = SampledBall::at(ground_, anchor);
        }
      },
      kUnitsPerTask);
  return balls;
}

Embedding IieScheme::Bound::embed(const UnitSet& units, std::span<const Placement> placements,
                                  std::span<const Word> words) const {
  Balls balls = balls_of(units, placements);
  Embedding embedding = embed_in(balls, radius_, placements, words);
  if (scheme_.options_.radius > 0) return embedding;
  // the mark changes the mean edge length a little, and with it the radius it will be read with
  for (int round = 0; round < kRadiusRounds; ++round) {
    const double radius =
        scheme_.options_.radius_edges * mean_edge_length({embedding.positions, mesh().triangles});
    embedding = embed_in(balls, radius, placements, words);
  }
  return embedding;
}

std::optional<CapMoves> IieScheme::Bound::exact_moves(SampledBall& sampled,
                                                      const Word& word) const {
  const std::optional<Plan> planned = scheme_.plan(sampled, word);
  if (!planned) return std::nullopt;
  return sampled.refined(planned->shift, planned->area, planned->volume);
}

Embedding IieScheme::Bound::embed_in(Balls& balls, double read_radius,
                                     std::span<const Placement> placements,
                                     std::span<const Word> words) const {
  return embed_each(placements.size(), [&](std::size_t index, std::vector<Vec3>& positions) {
    std::optional<SampledBall>& sampled = balls[index];
    if (!sampled || !sampled->set_read_radius(read_radius)) return false;
    const std::optional<CapMoves> moves = exact_moves(*sampled, words[placements[index].word]);
    if (!moves) return false;
    const Ball& ball = sampled->ball();
    for (std::size_t i = 0; i < ball.cap.size(); ++i) {
      positions[ball.cap[i]] += ball.normal * ball.move_of(i, *moves);
    }
    return true;
  });
}

IieScheme::Bound::Places IieScheme::Bound::places_at(std::vector<std::uint32_t> points) const {
  Places places{std::move(points), {}, {}};
  places.centres.resize(places.points.size());
  parallel_for(
      places.points.size(),
      [&](std::size_t i) {
        places.centres[i] = ground_.mean_of(
            points_within(surface().halfedges, places.points[i], ground_.centre_rings).value());
      },
      kUnitsPerTask);
  places.invariants =
      all_ball_invariants(mesh().positions, mesh().triangles, index_, sites_->at_boundary,
                          places.centres, radius_, ground_.most_triangles);
  return places;
}

// Mirroring reverses the rings unless the triangles are turned over as well, and either exchanges
// inside and outside unless both were done.
std::vector<std::vector<Reading>> IieScheme::Bound::read_turned_over() const {
  const IieSites turned =
      find_sites(surface().halfedges, mesh().positions.size(), scheme_.options_.site_rings,
                 scheme_.site_seed_, RingOrder::TurnedOver);
  const Places places = places_at(turned.points);
  return {readings_of(places, Inside::AsIs), readings_of(places, Inside::Outside),
          readings_of(own_sites(), Inside::Outside)};
}

std::vector<Reading> IieScheme::Bound::readings_of(const Places& places, Inside inside) const {
  const std::uint32_t marker_mask = (1U << scheme_.marker_bits_) - 1;
  std::vector<Reading> readings;
  std::vector<Vec3> centres;
  for (std::size_t i = 0; i < places.points.size(); ++i) {
    BallInvariants shares = places.invariants[i];
    if (inside == Inside::Outside) shares = {1 - shares.area, 1 - shares.volume};
    const Quantiser::Cell area = scheme_.area_.cell_of(shares.area);
    const Quantiser::Cell volume = scheme_.volume_.cell_of(shares.volume);
    const bool crosses = shares.area > 0 && shares.area < 1;  // false for a NaN
    if (!crosses || (area.bits & marker_mask) != scheme_.marker_) continue;
    const float squared = area.distance * area.distance + volume.distance * volume.distance;
    Reading reading;
    reading.anchor = places.points[i];
    reading.word = {area.bits >> scheme_.marker_bits_, volume.bits};
    reading.worst_offset = std::max(area.distance, volume.distance);
    reading.weight = static_cast<float>(std::exp(-kSharpness * double{squared}));
    reading.bit_weights.fill(1);
    readings.push_back(reading);
    centres.push_back(places.centres[i]);
  }
  return keep_best_apart(std::move(readings), centres, radius_);
}

// Every site is read: whether a reading stays depends on those about it.
std::vector<Reading> IieScheme::Bound::read_at(std::span<const std::uint32_t> anchors) const {
  std::vector<Reading> readings = read();
  std::erase_if(readings, [&](const Reading& reading) {
    return !std::binary_search(anchors.begin(), anchors.end(), reading.anchor);
  });
  return readings;
}

// The points within the ball; where that is no ball any more, those of its centre.
PointLists IieScheme::Bound::points_of(std::span<const std::uint32_t> anchors) const {
  PointLists lists;
  for (const std::uint32_t anchor : anchors) {
    std::vector<std::uint32_t> points;
    if (anchor < mesh().positions.size()) {
      points = points_within(surface().halfedges, anchor, scheme_.options_.centre_rings)
                   .value_or(std::vector<std::uint32_t>{anchor});
      const auto near =
          ground_.index.triangles_in_ball(ground_.mean_of(points), radius_, ground_.most_triangles);
      for (const std::uint32_t triangle : near.value_or(std::vector<std::uint32_t>{})) {
        const Triangle& corners = mesh().triangles[triangle];
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
