#include "engine/scheme/aie/edge_neighbourhood.h"

#include <algorithm>

#include "engine/mesh/turned_halfedges.h"

namespace triglyph {
namespace {

// The points around one basis point, counter-clockwise.
struct Ring {
  std::array<std::uint32_t, EdgeNeighbourhood::kMaxPoints> points;  // the first `size` count
  std::size_t size = 0;

  [[nodiscard]] bool contains(std::uint32_t point) const {
    const auto end = points.begin() + static_cast<std::ptrdiff_t>(size);
    return std::find(points.begin(), end, point) != end;
  }
};

// Fills an empty ring. False at a boundary or if the ring is too long.
template <typename Connectivity>
bool walk_ring(const Connectivity& halfedges, Halfedge first, Ring& ring) {
  Halfedge spoke = first;
  do {
    if (halfedges.is_boundary(spoke) || ring.size == ring.points.size()) return false;
    ring.points[ring.size++] = halfedges.to(spoke);
    spoke = halfedges.turned(spoke);
  } while (spoke != first);
  return true;
}

// Of the halfedge a -> b: the spokes from which the rings of a, b, c, d are walked.
struct RingStarts {
  std::array<Halfedge, 4> spokes;  // a -> b, b -> a, c -> a, d -> b: every ring begins with two
                                   // basis points and an outer apex; those of a and b end with an
                                   // outer apex and a basis point, those of c and d with an apex
  std::array<Halfedge, 4> outer;   // c -> a, d -> b, b -> c, a -> d: behind each lies a's, b's,
                                   // c's, d's outer apex
};

template <typename Connectivity>
RingStarts ring_starts_of(const Connectivity& halfedges, Halfedge along) {
  const Halfedge back = halfedges.opposite(along);
  const Halfedge from_c = halfedges.previous(along);
  const Halfedge from_d = halfedges.previous(back);
  return {{along, back, from_c, from_d},
          {from_c, from_d, halfedges.next(along), halfedges.next(back)}};
}

template <typename Connectivity>
std::optional<std::uint32_t> apex_behind(const Connectivity& halfedges, Halfedge side) {
  const Halfedge across = halfedges.opposite(side);
  if (halfedges.is_boundary(across)) return std::nullopt;
  return halfedges.to(halfedges.next(across));
}

bool all_different(std::span<const std::uint32_t> points) {
  for (std::size_t i = 1; i < points.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (points[i] == points[j]) return false;
    }
  }
  return true;
}

template <typename Connectivity>
std::optional<std::array<std::uint32_t, 4>> basis_in(const Connectivity& halfedges,
                                                     const RingStarts& starts) {
  if (halfedges.is_boundary(starts.spokes[0]) || halfedges.is_boundary(starts.spokes[1])) {
    return std::nullopt;
  }
  std::array<std::uint32_t, 4> basis{};
  for (std::size_t i = 0; i < 4; ++i) {
    basis[i] = halfedges.from(starts.spokes[i]);
  }
  if (!all_different(basis)) return std::nullopt;
  return basis;
}

// Collects the groups; says no where they cannot be told apart.
template <typename Connectivity>
class Grouping {
 public:
  Grouping(const Connectivity& halfedges, const RingStarts& starts, EdgeNeighbourhood& result)
      : halfedges_(halfedges), starts_(starts), result_(result) {}

  [[nodiscard]] bool collect(GroupRule rule, const GroupVisit& visit) {
    if (rule != GroupRule::OuterApexes && !walk_rings()) return false;
    for (std::size_t k = 0; k < 4; ++k) {
      result_.ends[k + 1] = result_.ends[k];
      if (!collect_group(rule, k) || result_.ends[k + 1] == result_.ends[k]) return false;
      if (visit && !visit(k, result_.group(k))) return false;
    }
    std::array<std::uint32_t, EdgeNeighbourhood::kMaxPoints + 4> all{};
    const auto groups = result_.all_groups();
    std::copy(result_.basis.begin(), result_.basis.end(), all.begin());
    std::copy(groups.begin(), groups.end(), all.begin() + 4);
    return all_different({all.data(), 4 + groups.size()});
  }

 private:
  bool walk_rings() {
    for (std::size_t k = 0; k < 4; ++k) {
      if (!walk_ring(halfedges_, starts_.spokes[k], rings_[k])) return false;
    }
    return true;
  }

  bool collect_group(GroupRule rule, std::size_t k) {
    const bool with_apex = rule == GroupRule::OuterApexes || rule == GroupRule::NeighboursAndApexes;
    if (rule != GroupRule::OuterApexes && !collect_exclusive(rule, k)) return false;
    if (!with_apex) return true;
    const std::optional<std::uint32_t> apex = apex_behind(halfedges_, starts_.outer[k]);
    return apex && append(k, *apex);
  }

  bool collect_exclusive(GroupRule rule, std::size_t k) {
    const Ring& ring = rings_[k];
    Ring exclusive;
    // between the basis points and apexes, which other rings have too
    const std::size_t end = ring.size - (k < 2 ? 2 : 1);
    for (std::size_t i = 3; i < end; ++i) {
      if (!is_shared(ring.points[i], k)) exclusive.points[exclusive.size++] = ring.points[i];
    }
    if (exclusive.size == 0) return false;
    if (rule == GroupRule::MiddleNeighbours) return append(k, exclusive.points[exclusive.size / 2]);
    for (std::size_t i = 0; i < exclusive.size; ++i) {
      if (!append(k, exclusive.points[i])) return false;
    }
    return true;
  }

  // Is a point of ring k in the basis or in another ring?
  bool is_shared(std::uint32_t point, std::size_t k) const {
    const auto& basis = result_.basis;
    if (std::find(basis.begin(), basis.end(), point) != basis.end()) return true;
    for (std::size_t other = 0; other < 4; ++other) {
      if (other != k && rings_[other].contains(point)) return true;
    }
    return false;
  }

  bool append(std::size_t k, std::uint32_t point) {
    if (result_.ends[k + 1] == EdgeNeighbourhood::kMaxPoints) return false;
    result_.points[result_.ends[k + 1]++] = point;
    return true;
  }

  const Connectivity& halfedges_;
  const RingStarts& starts_;
  EdgeNeighbourhood& result_;
  std::array<Ring, 4> rings_;
};

template <typename Connectivity>
std::optional<EdgeNeighbourhood> neighbourhood_along(const Connectivity& halfedges, Halfedge along,
                                                     GroupRule rule, const GroupVisit& visit) {
  const RingStarts starts = ring_starts_of(halfedges, along);
  const auto basis = basis_in(halfedges, starts);
  if (!basis) return std::nullopt;
  EdgeNeighbourhood result;
  result.basis = *basis;
  if (!Grouping(halfedges, starts, result).collect(rule, visit)) return std::nullopt;
  return result;
}

}  // namespace

std::optional<std::array<std::uint32_t, 4>> basis_of(const Surface& surface, std::uint32_t edge,
                                                     EdgeWay way) {
  const Halfedge along = surface.halfedges.of_edge(edge, way == EdgeWay::Backward ? 1 : 0);
  if (way == EdgeWay::TurnedOver) {
    const TurnedHalfedges turned(surface.halfedges);
    return basis_in(turned, ring_starts_of(turned, along));
  }
  return basis_in(surface.halfedges, ring_starts_of(surface.halfedges, along));
}

std::optional<EdgeNeighbourhood> neighbourhood_of(const Surface& surface, std::uint32_t edge,
                                                  EdgeWay way, GroupRule rule,
                                                  const GroupVisit& visit) {
  const Halfedge along = surface.halfedges.of_edge(edge, way == EdgeWay::Backward ? 1 : 0);
  if (way == EdgeWay::TurnedOver) {
    return neighbourhood_along(TurnedHalfedges(surface.halfedges), along, rule, visit);
  }
  return neighbourhood_along(surface.halfedges, along, rule, visit);
}

}  // namespace triglyph
