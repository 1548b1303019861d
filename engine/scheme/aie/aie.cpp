#include "engine/scheme/aie/aie.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "engine/base/error.h"
#include "engine/base/parallel.h"
#include "engine/base/random.h"
#include "engine/scheme/cost_rows.h"
#include "engine/scheme/surface_binding.h"

namespace triglyph {
namespace {

// Flatness below which a basis is read as plane. Both limits of marking are twenty times away, so
// that neither rounding nor affine maps take a marked unit across.
constexpr double kPlaneBelow = 2e-4;
// Flatness up to which a basis is marked as plane, and height in greatest deviations up to which
// its neighbours count as lying in that plane: flat but for rounding.
constexpr double kExactPlane = 1e-5;
// Flatness from which on a basis is marked as solid: the norm amplifies rounding by 1 / flatness,
// and marks on thinner bases do not survive it.
constexpr double kMinFlatness = 4e-3;
// Straightness from which on a basis is marked: along a needle the norm amplifies rounding within
// the plane, too.
constexpr double kMinStraightness = 0.02;
// Height in greatest deviations up to which a point is read over a plane basis: a hundred times
// kExactPlane, for what rounding and affine maps add.
constexpr double kMaxHeight = 1e-3;
// Greatest move in greatest deviations of the basis: one as far as the basis is wide would be seen,
// and would flip a face as a rule.
constexpr double kMaxMoveInDeviations = 1;
// Factor of a lower bound on a distance: rounding takes far less from the distance.
constexpr double kSurely = 1 - 1e-6;
// A group holds a quarter of the word and has a table of costs for all its values: 2^8 at most.
constexpr int kMaxWordBits = 32;
// Any number; it draws the edges of a sample.
constexpr std::uint64_t kSampleSeed = 0x616965;

std::array<Vec3, 4> corners_of(const Mesh& mesh, const std::array<std::uint32_t, 4>& basis) {
  return {mesh.positions[basis[0]], mesh.positions[basis[1]], mesh.positions[basis[2]],
          mesh.positions[basis[3]]};
}

int word_bits(const WordFormat& format) {
  return format.marker_bits + format.subscript_bits + format.part_bits;
}

}  // namespace

struct AieScheme::Basis {
  std::uint32_t edge;
  AffineNorm norm;
};

struct AieScheme::Site {
  EdgeNeighbourhood around;
  AffineNorm norm;
  double reach;  // greatest move, model units
};

struct AieScheme::Way {
  bool shows_marker = true;  // in the groups read so far
  std::array<GroupReading, 4> groups;
};

// The scheme on one surface.
class AieScheme::Bound final : public SurfaceBinding {
 public:
  Bound(const AieScheme& scheme, const Surface& surface)
      : SurfaceBinding(surface, scheme.options_), scheme_(scheme) {}

  [[nodiscard]] UnitSet find_units() const override;
  [[nodiscard]] CostMatrix costs(const UnitSet& units, std::span<const std::uint32_t> chosen,
                                 std::span<const Word> words) const override;
  [[nodiscard]] Embedding embed(const UnitSet& units, std::span<const Placement> placements,
                                std::span<const Word> words) const override;
  [[nodiscard]] std::vector<Reading> read() const override { return read_edges(EdgeWay::Forward); }
  // The norm does not tell a surface from its mirror image.
  [[nodiscard]] std::vector<std::vector<Reading>> read_turned_over() const override {
    return {read_edges(EdgeWay::TurnedOver)};
  }
  [[nodiscard]] std::optional<std::vector<Reading>> read_sample(
      std::uint32_t one_in) const override;
  [[nodiscard]] std::vector<Reading> read_at(std::span<const std::uint32_t> anchors) const override;
  [[nodiscard]] PointLists points_of(std::span<const std::uint32_t> anchors) const override;
  [[nodiscard]] std::unique_ptr<BoundScheme> moved_to(const Surface& moved) const override {
    return std::make_unique<Bound>(scheme_, moved);
  }

 private:
  [[nodiscard]] std::vector<Reading> read_edges(EdgeWay way) const;
  // Appends what an edge shows with each grouping, if it shows the marker; `way` is forward or
  // turned over, and the opposite direction is read with either.
  void read_edge(std::uint32_t edge, EdgeWay way, std::vector<Reading>& out) const;

  const AieScheme& scheme_;
};

AieScheme::Channel AieScheme::make_channel(const WordCode& code, double step, std::size_t group) {
  const int bits = (word_bits(code.format()) + 3 - static_cast<int>(group)) / 4;
  return {Quantiser(step, bits, code.offset(group)),
          Quantiser(step / kPlaneSteps, bits, code.offset(group))};
}

AieScheme::AieScheme(const WordCode& code, const AieOptions& options)
    : options_(options),
      format_(code.format()),
      marker_(code.marker()),
      channels_{make_channel(code, options.step, 0), make_channel(code, options.step, 1),
                make_channel(code, options.step, 2), make_channel(code, options.step, 3)} {
  if (!(options.step > 0 && options.step <= 0.5)) {
    throw Error(ErrorCode::Usage, {}, "", "the cell width of aie lies above 0 and up to 0.5");
  }
  if (word_bits(format_) > kMaxWordBits) {
    throw Error(ErrorCode::Usage, {}, "", "aie holds 32 bits a unit: marker, subscript and part");
  }
}

std::unique_ptr<BoundScheme> AieScheme::bind(const Surface& surface) const {
  return std::make_unique<Bound>(*this, surface);
}

GroupRule AieScheme::rule_of(std::uint32_t anchor) const {
  const bool first = anchor % kAlternatives == 0;
  if (options_.groups == AieGroups::One) {
    return first ? GroupRule::OuterApexes : GroupRule::MiddleNeighbours;
  }
  return first ? GroupRule::ExclusiveNeighbours : GroupRule::NeighboursAndApexes;
}

AieScheme::GroupBits AieScheme::deal_out(const Word& word) const {
  const std::uint64_t all = marker_ | std::uint64_t{word.subscript} << format_.marker_bits |
                            std::uint64_t{word.part}
                                << (format_.marker_bits + format_.subscript_bits);
  GroupBits bits{};
  for (std::size_t i = 0; i < static_cast<std::size_t>(word_bits(format_)); ++i) {
    bits[i % 4] |= static_cast<std::uint32_t>(all >> i & 1) << (i / 4);
  }
  return bits;
}

// The nearest place for these bits on either side; the nearer cell is not always the shorter way.
std::optional<Vec3> AieScheme::place(const Site& site, std::size_t group, const Vec3& point,
                                     std::uint32_t bits) const {
  const Quantiser& quantiser = channels_[group].quantiser(site.norm);
  const double norm = site.norm(point);
  const double value = std::log(norm);
  if (!std::isfinite(value)) return std::nullopt;
  const double near = quantiser.nearest_centre(value, bits);
  std::optional<Vec3> best;
  double best_move = site.reach;
  for (const double centre : {near, quantiser.second_centre(value, near)}) {
    const double wanted = std::exp(centre);
    // most second cells end here, before their dear nearest point
    if (!(kSurely * site.norm.least_distance(norm, wanted) < best_move)) continue;
    const Vec3 target = site.norm.nearest_with_norm(point, wanted);
    const double move = (target - point).norm();
    if (!(move < best_move)) continue;
    best_move = move;
    best = target;
  }
  return best;
}

std::optional<AieScheme::Basis> AieScheme::basis_at(const Surface& surface, std::uint32_t edge) {
  const auto points = basis_of(surface, edge, EdgeWay::Forward);
  if (!points) return std::nullopt;
  const AffineNorm norm(corners_of(surface.mesh, *points), kPlaneBelow);
  const bool exact =
      norm.is_plane() ? norm.flatness() <= kExactPlane : norm.flatness() >= kMinFlatness;
  if (!exact || norm.straightness() < kMinStraightness) return std::nullopt;
  return Basis{edge, norm};
}

// Those that may be moved: over a plane basis none may stand out of the plane.
std::optional<EdgeNeighbourhood> AieScheme::neighbours_of(const Surface& surface,
                                                          const Basis& basis,
                                                          std::uint32_t anchor) const {
  auto around = neighbourhood_of(surface, basis.edge, EdgeWay::Forward, rule_of(anchor));
  if (!around || !basis.norm.is_plane()) return around;
  for (const std::uint32_t point : around->all_groups()) {
    if (basis.norm.height(surface.mesh.positions[point]) > kExactPlane) return std::nullopt;
  }
  return around;
}

std::optional<AieScheme::Site> AieScheme::site_at(const Surface& surface,
                                                  std::uint32_t anchor) const {
  const auto basis = basis_at(surface, anchor / kAlternatives);
  if (!basis) return std::nullopt;
  const auto around = neighbours_of(surface, *basis, anchor);
  if (!around) return std::nullopt;
  return Site{*around, basis->norm, kMaxMoveInDeviations * basis->norm.greatest_deviation()};
}

float AieScheme::group_cost(const Mesh& mesh, const LocalCost& local, const Site& site,
                            std::size_t group, std::uint32_t bits) const {
  std::array<Move, EdgeNeighbourhood::kMaxPoints> moves;
  std::size_t count = 0;
  for (const std::uint32_t point : site.around.group(group)) {
    const std::optional<Vec3> to = place(site, group, mesh.positions[point], bits);
    if (!to) return kInfeasible;
    moves[count++] = {point, *to};
  }
  return local.of_part(std::span<const Move>(moves.data(), count));
}

UnitSet AieScheme::Bound::find_units() const {
  const std::size_t edges = surface().halfedges.edge_count();
  std::vector<UnitSet> parts((edges + kBlock - 1) / kBlock);
  const auto find_at = [&](std::uint32_t edge, UnitSet& found) {
    const std::optional<Basis> basis = basis_at(surface(), edge);
    if (!basis) return;
    for (std::uint32_t i = 0; i < kAlternatives; ++i) {
      const std::uint32_t anchor = kAlternatives * edge + i;
      const auto around = scheme_.neighbours_of(surface(), *basis, anchor);
      if (!around) continue;
      const auto moved = around->all_groups();
      found.anchors.push_back(anchor);
      found.moved.append(moved);
      found.read.points.insert(found.read.points.end(), around->basis.begin(), around->basis.end());
      found.read.append(moved);
    }
  };
  parallel_blocks(edges, [&](std::size_t begin, std::size_t end) {
    for (std::size_t edge = begin; edge < end; ++edge) {
      find_at(static_cast<std::uint32_t>(edge), parts[begin / kBlock]);
    }
  });
  std::size_t count = 0, points = 0;
  for (const UnitSet& part : parts) {
    count += part.size();
    points += part.read.points.size();
  }
  UnitSet units;
  units.anchors.reserve(count);
  units.moved.offsets.reserve(count + 1);
  units.moved.points.reserve(points - 4 * count);
  units.read.offsets.reserve(count + 1);
  units.read.points.reserve(points);
  for (const UnitSet& part : parts) {
    units.anchors.insert(units.anchors.end(), part.anchors.begin(), part.anchors.end());
    units.moved.append(part.moved);
    units.read.append(part.read);
  }
  return units;
}

CostMatrix AieScheme::Bound::costs(const UnitSet& units, std::span<const std::uint32_t> chosen,
                                   std::span<const Word> words) const {
  std::vector<GroupBits> bits_of;
  for (const Word& word : words) bits_of.push_back(scheme_.deal_out(word));
  const LocalCost& local = local_cost();
  return fill_cost_rows(chosen.size(), words.size(), [&](std::size_t row, std::span<float> costs) {
    const std::optional<Site> site = scheme_.site_at(surface(), units.anchors[chosen[row]]);
    if (!site) return;
    // a group has few values and many words share them
    std::array<std::vector<float>, 4> known;
    for (std::size_t k = 0; k < 4; ++k) {
      known[k].assign(std::size_t{1} << scheme_.channels_[k].bits(), -1);
    }
    for (std::size_t word = 0; word < costs.size(); ++word) {
      std::array<float, 4> group_costs{};
      for (std::size_t k = 0; k < 4; ++k) {
        float& cost = known[k][bits_of[word][k]];
        if (cost < 0) cost = scheme_.group_cost(mesh(), local, *site, k, bits_of[word][k]);
        group_costs[k] = cost;
      }
      costs[word] = local.combine(group_costs, site->around.all_groups().size());
    }
  });
}

Embedding AieScheme::Bound::embed(const UnitSet& units, std::span<const Placement> placements,
                                  std::span<const Word> words) const {
  return embed_each(placements.size(), [&](std::size_t index, std::vector<Vec3>& positions) {
    const Placement& placement = placements[index];
    const std::optional<Site> site = scheme_.site_at(surface(), units.anchors[placement.unit]);
    if (!site) return false;
    const GroupBits bits = scheme_.deal_out(words[placement.word]);
    std::array<Vec3, EdgeNeighbourhood::kMaxPoints> targets;
    std::size_t next = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      for (const std::uint32_t point : site->around.group(k)) {
        const auto to = scheme_.place(*site, k, mesh().positions[point], bits[k]);
        if (!to) return false;
        targets[next++] = *to;
      }
    }
    const auto points = site->around.all_groups();
    for (std::size_t i = 0; i < points.size(); ++i) positions[points[i]] = targets[i];
    return true;
  });
}

// A group's points carry the same bits; where they disagree, those nearest to their cells' centres
// win. Its distance counts every point that disagrees as one on the border.
AieScheme::GroupReading AieScheme::read_group(const Quantiser& quantiser,
                                              std::span<const double> values) {
  std::array<Quantiser::Cell, EdgeNeighbourhood::kMaxPoints> cells;
  for (std::size_t i = 0; i < values.size(); ++i) cells[i] = quantiser.cell_of(values[i]);
  GroupReading result;
  float best = -1;
  for (std::size_t i = 0; i < values.size(); ++i) {
    float support = 0;
    std::size_t supporters = 0;
    for (std::size_t j = 0; j < values.size(); ++j) {
      if (cells[j].bits != cells[i].bits) continue;
      support += 1 - cells[j].distance;
      ++supporters;
    }
    if (support <= best) continue;
    best = support;
    result.bits = cells[i].bits;
    result.unanimous = supporters == values.size();
  }
  result.distance = 1 - best / static_cast<float>(values.size());
  return result;
}

// Of the marker's bits, those that were dealt out to this group.
bool AieScheme::shows_marker(std::size_t group, std::uint32_t bits) const {
  for (int i = static_cast<int>(group); i < format_.marker_bits; i += 4) {
    if ((bits >> (i / 4) & 1) != (marker_ >> i & 1)) return false;
  }
  return true;
}

AieScheme::UnitReading AieScheme::unit_of(const Way& way, std::uint32_t anchor) const {
  const auto bit_of_word = [&](int i) {
    return way.groups[static_cast<std::size_t>(i % 4)].bits >> (i / 4) & 1;
  };
  UnitReading unit;
  Reading& reading = unit.reading;
  reading.anchor = anchor;
  reading.weight = 1;
  for (const GroupReading& group : way.groups) {
    reading.weight *= 1 - group.distance;
    reading.worst_offset = std::max(reading.worst_offset, group.distance);
    unit.unanimous = unit.unanimous && group.unanimous;
  }
  for (int i = 0; i < format_.subscript_bits; ++i) {
    reading.word.subscript |= bit_of_word(format_.marker_bits + i) << i;
  }
  for (int i = 0; i < format_.part_bits; ++i) {
    const int at = format_.marker_bits + format_.subscript_bits + i;
    reading.word.part |= bit_of_word(at) << i;
    reading.bit_weights[static_cast<std::size_t>(i)] =
        1 - way.groups[static_cast<std::size_t>(at % 4)].distance;
  }
  return unit;
}

// Along the edge and against it: the points are the same, and group k of the one way is group k ^ 1
// of the other. Most edges show the marker neither way after a group or two, and end there.
std::optional<AieScheme::UnitReading> AieScheme::read_unit(const Surface& surface,
                                                           const AffineNorm& norm,
                                                           std::uint32_t anchor,
                                                           EdgeWay way) const {
  std::array<Way, 2> ways;
  const auto read_both_ways = [&](std::size_t k, std::span<const std::uint32_t> points) {
    std::array<double, EdgeNeighbourhood::kMaxPoints> values;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vec3& position = surface.mesh.positions[points[i]];
      if (norm.is_plane() && norm.height(position) > kMaxHeight) return false;
      values[i] = std::log(norm(position));
    }
    for (std::size_t direction = 0; direction < 2; ++direction) {
      Way& read = ways[direction];
      if (!read.shows_marker) continue;
      const std::size_t group = k ^ direction;
      read.groups[group] =
          read_group(channels_[group].quantiser(norm), {values.data(), points.size()});
      read.shows_marker = shows_marker(group, read.groups[group].bits);
    }
    return ways[0].shows_marker || ways[1].shows_marker;
  };
  const bool is_whole = neighbourhood_of(surface, anchor / kAlternatives, way, rule_of(anchor),
                                         std::cref(read_both_ways))
                            .has_value();
  if (!is_whole) return std::nullopt;
  std::optional<UnitReading> forward, backward;
  if (ways[0].shows_marker) forward = unit_of(ways[0], anchor);
  if (ways[1].shows_marker) backward = unit_of(ways[1], anchor);
  const bool turned = backward && (!forward || backward->reading.weight > forward->reading.weight);
  return turned ? backward : forward;
}

void AieScheme::Bound::read_edge(std::uint32_t edge, EdgeWay way, std::vector<Reading>& out) const {
  const auto basis = basis_of(surface(), edge, way);
  if (!basis) return;
  const AffineNorm norm(corners_of(mesh(), *basis), kPlaneBelow);
  if (!(norm.straightness() > 0)) return;
  auto first = scheme_.read_unit(surface(), norm, kAlternatives * edge, way);
  auto second = scheme_.read_unit(surface(), norm, kAlternatives * edge + 1, way);
  const bool nested = scheme_.options_.groups == AieGroups::All;
  if (nested && first && second && first->reading.word == second->reading.word) {
    // one unit. Its points are those of the larger grouping if all of these agree: in a unit of
    // the smaller one the others are strangers, and agree with chance 2^-(bits of the word).
    const bool larger = second->unanimous || second->reading.weight > first->reading.weight;
    (larger ? first : second).reset();
  }
  if (first) out.push_back(first->reading);
  if (second) out.push_back(second->reading);
}

std::vector<Reading> AieScheme::Bound::read_edges(EdgeWay way) const {
  return parallel_collect<Reading>(surface().halfedges.edge_count(),
                                   [&](std::size_t edge, std::vector<Reading>& out) {
                                     read_edge(static_cast<std::uint32_t>(edge), way, out);
                                   });
}

std::optional<std::vector<Reading>> AieScheme::Bound::read_sample(std::uint32_t one_in) const {
  return parallel_collect<Reading>(
      surface().halfedges.edge_count(), [&](std::size_t edge, std::vector<Reading>& out) {
        if (random_bits(kSampleSeed, 0, edge) % one_in != 0) return;
        read_edge(static_cast<std::uint32_t>(edge), EdgeWay::Forward, out);
      });
}

// Whole edges are read: where groupings are nested, one may count in place of the other.
std::vector<Reading> AieScheme::Bound::read_at(std::span<const std::uint32_t> anchors) const {
  return parallel_collect<Reading>(anchors.size(), [&](std::size_t i, std::vector<Reading>& out) {
    const std::uint32_t edge = anchors[i] / kAlternatives;
    if (edge >= surface().halfedges.edge_count()) return;
    std::vector<Reading> shown;
    read_edge(edge, EdgeWay::Forward, shown);
    for (const Reading& reading : shown) {
      if (reading.anchor == anchors[i]) out.push_back(reading);
    }
  });
}

PointLists AieScheme::Bound::points_of(std::span<const std::uint32_t> anchors) const {
  PointLists lists;
  for (const std::uint32_t anchor : anchors) {
    std::vector<std::uint32_t> points;
    if (anchor / kAlternatives < surface().halfedges.edge_count()) {
      const auto around = neighbourhood_of(surface(), anchor / kAlternatives, EdgeWay::Forward,
                                           scheme_.rule_of(anchor));
      if (around) {
        points.assign(around->basis.begin(), around->basis.end());
        points.insert(points.end(), around->all_groups().begin(), around->all_groups().end());
      }
    }
    std::sort(points.begin(), points.end());
    lists.append(points);
  }
  return lists;
}

}  // namespace triglyph
