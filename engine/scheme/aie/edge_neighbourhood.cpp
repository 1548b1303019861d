#include "engine/scheme/aie/edge_neighbourhood.h"

#include <algorithm>

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
bool walk_ring(const Halfedges& halfedges, Halfedge first, Ring& ring) {
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

RingStarts ring_starts_of(const Halfedges& halfedges, std::uint32_t edge, bool reversed) {
  const Halfedge along = halfedges.of_edge(edge, reversed ? 1 : 0);
  const Halfedge back = halfedges.opposite(along);
  const Halfedge from_c = halfedges.previous(along);
  const Halfedge from_d = halfedges.previous(back);
  return {{along, back, from_c, from_d},
          {from_c, from_d, halfedges.next(along), halfedges.next(back)}};
}

std::optional<std::uint32_t> apex_behind(const Surface& surface, Halfedge side) {
  const Halfedges& halfedges = surface.halfedges;
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

std::optional<std::array<std::uint32_t, 4>> basis_in(const Surface& surface,
                                                     const RingStarts& starts) {
  const Halfedges& halfedges = surface.halfedges;
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
class Grouping {
 public:
  Grouping(const Surface& surface, const RingStarts& starts, EdgeNeighbourhood& result)
      : surface_(surface), starts_(starts), result_(result) {}

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
      if (!walk_ring(surface_.halfedges, starts_.spokes[k], rings_[k])) return false;
    }
    return true;
  }

  bool collect_group(GroupRule rule, std::size_t k) {
    const bool with_apex = rule == GroupRule::OuterApexes || rule == GroupRule::NeighboursAndApexes;
    if (rule != GroupRule::OuterApexes && !collect_exclusive(rule, k)) return false;
    if (!with_apex) return true;
    const std::optional<std::uint32_t> apex = apex_behind(surface_, starts_.outer[k]);
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

  const Surface& surface_;
  const RingStarts& starts_;
  EdgeNeighbourhood& result_;
  std::array<Ring, 4> rings_;
};

}  // namespace

std::optional<std::array<std::uint32_t, 4>> basis_of(const Surface& surface, std::uint32_t edge,
                                                     bool reversed) {
  return basis_in(surface, ring_starts_of(surface.halfedges, edge, reversed));
}

std::optional<EdgeNeighbourhood> neighbourhood_of(const Surface& surface, std::uint32_t edge,
                                                  bool reversed, GroupRule rule,
                                                  const GroupVisit& visit) {
  const RingStarts starts = ring_starts_of(surface.halfedges, edge, reversed);
  const auto basis = basis_in(surface, starts);
  if (!basis) return std::nullopt;
  EdgeNeighbourhood result;
  result.basis = *basis;
  if (!Grouping(surface, starts, result).collect(rule, visit)) return std::nullopt;
  return result;
}

}  // namespace triglyph
