#include "engine/scheme/iie/local_iie.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "engine/base/error.h"
#include "engine/base/once.h"
#include "engine/base/parallel.h"
#include "engine/base/random.h"
#include "engine/geometry/spatial_index.h"
#include "engine/scheme/cost_rows.h"
#include "engine/scheme/iie/sites.h"
#include "engine/scheme/surface_binding.h"

namespace triglyph {
namespace {

// How fast the weight of a reading falls with the distance from its cell's centre: a place without
// a mark reads as well anywhere in a cell, and one with a mark under much noise nearly so.
constexpr double kLocalSharpness = 1.5;
constexpr std::size_t kLocalUnitsPerTask = 4;  // balls are dear, and some far dearer than others
constexpr int kLocalMaxQuantiserBits = 16;     // of Quantiser

int cell_bits(const WordFormat& format) {
  return format.marker_bits + format.part_bits;
}

}  // namespace

// The scheme on one surface.
class LocalIieScheme::Bound final : public SurfaceBinding {
 public:
  // `sites` of the surface's connectivity.
  Bound(const LocalIieScheme& scheme, const Surface& surface, std::shared_ptr<const IieSites> sites)
      : SurfaceBinding(surface, scheme.options_),
        scheme_(scheme),
        sites_(std::move(sites)),
        index_(surface.mesh.positions, surface.mesh.triangles),
        ground_{this->surface(),        index_,
                sites_->at_boundary,    scheme.options_.radius_edges,
                scheme.options_.radius, scheme.options_.centre_rings} {}

  [[nodiscard]] UnitSet find_units() const override;
  [[nodiscard]] CostMatrix costs(const UnitSet& units, std::span<const std::uint32_t> chosen,
                                 std::span<const Word> words) const override;
  [[nodiscard]] Embedding embed(const UnitSet& units, std::span<const Placement> placements,
                                std::span<const Word> words) const override;
  [[nodiscard]] std::vector<Reading> read() const override { return readings(Inside::AsIs); }
  // The sites are those of the mirror image, and what differs is which side is inside.
  [[nodiscard]] std::vector<std::vector<Reading>> read_turned_over() const override {
    return {readings(Inside::Outside)};
  }
  [[nodiscard]] std::vector<Reading> read_at(std::span<const std::uint32_t> anchors) const override;
  [[nodiscard]] PointLists points_of(std::span<const std::uint32_t> anchors) const override;
  [[nodiscard]] std::unique_ptr<BoundScheme> moved_to(const Surface& moved) const override {
    return std::make_unique<Bound>(scheme_, moved, sites_);
  }

 private:
  // Is the inside of the surface read as inside, or the outside?
  enum class Inside { AsIs, Outside };

  // Appends what a site shows that has this share, if it shows the marker.
  void read_site(std::size_t site, double share, std::vector<Reading>& out) const;
  [[nodiscard]] std::vector<Reading> readings(Inside inside) const;
  [[nodiscard]] std::uint64_t signature_at(std::uint32_t anchor) const {
    const auto at = std::lower_bound(sites_->points.begin(), sites_->points.end(), anchor);
    return sites_->signatures[static_cast<std::size_t>(at - sites_->points.begin())];
  }

  const LocalIieScheme& scheme_;
  std::shared_ptr<const IieSites> sites_;
  SpatialIndex index_;
  LocalGround ground_;
  Once<std::vector<double>> shares_;  // of all sites
};

LocalIieScheme::LocalIieScheme(const WordCode& code, const IieOptions& options)
    : options_(options),
      format_(code.format()),
      marker_(code.marker()),
      quantiser_(options.step, std::min(cell_bits(code.format()), kLocalMaxQuantiserBits),
                 code.offset(0)),
      site_seed_(std::bit_cast<std::uint64_t>(code.offset(2))) {
  const auto refuse = [](const char* what) { throw Error(ErrorCode::Usage, {}, "", what); };
  if (cell_bits(format_) > kLocalMaxQuantiserBits) {
    refuse("the local encoding of iie holds 16 bits of marker and part");
  }
  options.check();
}

std::unique_ptr<BoundScheme> LocalIieScheme::bind(const Surface& surface) const {
  return std::make_unique<Bound>(
      *this, surface,
      std::make_shared<IieSites>(scatter_sites(surface.halfedges, surface.mesh.positions.size(),
                                               options_.site_rings, site_seed_)));
}

LocalIieScheme::SiteKey LocalIieScheme::key_of(std::uint64_t signature) const {
  const auto low = [](std::uint64_t bits, int count) {
    return static_cast<std::uint32_t>(bits & ((std::uint64_t{1} << count) - 1));
  };
  return {low(random_bits(site_seed_, 3, signature), format_.subscript_bits),
          low(random_bits(site_seed_, 4, signature), cell_bits(format_))};
}

// A bit that the neighbouring cell has too is surer than one that changes at the near border.
float LocalIieScheme::bit_weight(double share, const Quantiser::Cell& cell, int bit) const {
  const double half = 0.5 * quantiser_.step();
  const std::uint32_t flips = (quantiser_.cell_of(share - half).bits ^ cell.bits) |
                              (quantiser_.cell_of(share + half).bits ^ cell.bits);
  return (flips >> bit & 1) != 0 ? 1 - cell.distance : 1;
}

std::optional<LocalIieScheme::Plan> LocalIieScheme::plan(LocalBall& ball,
                                                         std::uint32_t bits) const {
  const double share = ball.share(0);
  const double near = quantiser_.nearest_centre(share, bits);
  std::optional<Plan> best;
  for (const double wanted : {near, quantiser_.second_centre(share, near)}) {
    const std::optional<double> height = ball.height_for(wanted);
    if (height && (!best || std::abs(*height) < std::abs(best->height))) {
      best = Plan{wanted, *height};
    }
  }
  return best;
}

float LocalIieScheme::cost_of(const Mesh& mesh, const LocalCost& local, const LocalBall& ball,
                              double height) const {
  if (options_.cost == CostFunction::Displacement) {
    return static_cast<float>(std::abs(height) * ball.greatest_profile());
  }
  if (options_.cost == CostFunction::Rms) {
    return static_cast<float>(std::abs(height) * ball.rms_profile());
  }
  std::vector<Move> moves;
  ball.for_each_move(height, [&](std::uint32_t point, const Vec3& move) {
    moves.push_back({point, mesh.positions[point] + move});
  });
  return local.of_part(moves);
}

UnitSet LocalIieScheme::Bound::find_units() const {
  std::vector<SiteUnit> found(sites_->points.size());
  parallel_for(
      found.size(),
      [&](std::size_t i) {
        const std::optional<LocalBall> ball = LocalBall::at(ground_, sites_->points[i]);
        if (!ball) return;
        found[i] = {ball->moved(), {ball->points().begin(), ball->points().end()}};
      },
      kLocalUnitsPerTask);
  return units_at(*sites_, found);
}

CostMatrix LocalIieScheme::Bound::costs(const UnitSet& units, std::span<const std::uint32_t> chosen,
                                        std::span<const Word> words) const {
  const LocalCost& local = local_cost();
  return fill_cost_rows(chosen.size(), words.size(), [&](std::size_t row, std::span<float> costs) {
    const std::uint32_t anchor = units.anchors[chosen[row]];
    std::optional<LocalBall> ball = LocalBall::at(ground_, anchor);
    if (!ball) return;
    const SiteKey key = scheme_.key_of(signature_at(anchor));
    for (std::size_t word = 0; word < costs.size(); ++word) {
      if (words[word].subscript != key.subscript) continue;
      const auto planned = scheme_.plan(*ball, scheme_.bits_of(words[word], key));
      if (planned) costs[word] = scheme_.cost_of(mesh(), local, *ball, planned->height);
    }
  });
}

Embedding LocalIieScheme::Bound::embed(const UnitSet& units, std::span<const Placement> placements,
                                       std::span<const Word> words) const {
  return embed_each(placements.size(), [&](std::size_t index, std::vector<Vec3>& positions) {
    const std::uint32_t anchor = units.anchors[placements[index].unit];
    std::optional<LocalBall> ball = LocalBall::at(ground_, anchor);
    if (!ball) return false;
    const Word& word = words[placements[index].word];
    const SiteKey key = scheme_.key_of(signature_at(anchor));
    if (word.subscript != key.subscript) return false;
    const std::optional<Plan> planned = scheme_.plan(*ball, scheme_.bits_of(word, key));
    if (!planned) return false;
    const std::optional<double> height = ball->refined(planned->height, planned->share);
    if (!height) return false;
    ball->for_each_move(*height,
                        [&](std::uint32_t point, const Vec3& move) { positions[point] += move; });
    return true;
  });
}

void LocalIieScheme::Bound::read_site(std::size_t site, double share,
                                      std::vector<Reading>& out) const {
  if (!std::isfinite(share)) return;
  const WordFormat& format = scheme_.format_;
  const Quantiser::Cell cell = scheme_.quantiser_.cell_of(share);
  const SiteKey key = scheme_.key_of(sites_->signatures[site]);
  const std::uint32_t bits = cell.bits ^ key.mask;
  if ((bits & ((1U << format.marker_bits) - 1)) != scheme_.marker_) return;
  Reading reading;
  reading.anchor = sites_->points[site];
  reading.word = {key.subscript, bits >> format.marker_bits};
  reading.worst_offset = cell.distance;
  reading.weight = static_cast<float>(
      std::exp(-kLocalSharpness * double{cell.distance} * double{cell.distance}));
  for (int bit = 0; bit < format.part_bits; ++bit) {
    reading.bit_weights[static_cast<std::size_t>(bit)] =
        scheme_.bit_weight(share, cell, format.marker_bits + bit);
  }
  out.push_back(reading);
}

std::vector<Reading> LocalIieScheme::Bound::readings(Inside inside) const {
  const std::vector<double>& shares = shares_.get([&] {
    std::vector<double> made(sites_->points.size());
    parallel_for(
        made.size(), [&](std::size_t i) { made[i] = sphere_share(ground_, sites_->points[i]); },
        kLocalUnitsPerTask);
    return made;
  });
  std::vector<Reading> readings;
  for (std::size_t i = 0; i < shares.size(); ++i) {
    read_site(i, inside == Inside::AsIs ? shares[i] : 1 - shares[i], readings);
  }
  return readings;
}

std::vector<Reading> LocalIieScheme::Bound::read_at(std::span<const std::uint32_t> anchors) const {
  std::vector<std::size_t> sites;
  for (const std::uint32_t anchor : anchors) {
    const auto at = std::lower_bound(sites_->points.begin(), sites_->points.end(), anchor);
    if (at == sites_->points.end() || *at != anchor) continue;
    sites.push_back(static_cast<std::size_t>(at - sites_->points.begin()));
  }
  std::vector<double> shares(sites.size());
  parallel_for(
      shares.size(),
      [&](std::size_t i) { shares[i] = sphere_share(ground_, sites_->points[sites[i]]); },
      kLocalUnitsPerTask);
  std::vector<Reading> readings;
  for (std::size_t i = 0; i < sites.size(); ++i) read_site(sites[i], shares[i], readings);
  return readings;
}

// The points on which the share depends; where there is no ball any more, those of its centre.
PointLists LocalIieScheme::Bound::points_of(std::span<const std::uint32_t> anchors) const {
  PointLists lists;
  for (const std::uint32_t anchor : anchors) {
    std::vector<std::uint32_t> points;
    if (anchor < mesh().positions.size()) {
      const std::optional<LocalBall> ball = LocalBall::at(ground_, anchor);
      if (ball) {
        points.assign(ball->points().begin(), ball->points().end());
      } else {
        points = points_within(surface().halfedges, anchor, scheme_.options_.centre_rings)
                     .value_or(std::vector<std::uint32_t>{anchor});
      }
    }
    lists.append(points);
  }
  return lists;
}

}  // namespace triglyph
