// The places where IIE may put units, which depend on the connectivity alone: no motion, rounding
// or noise changes them.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/mesh/halfedges.h"
#include "engine/scheme/iie/ring_signature.h"
#include "engine/scheme/scheme.h"

namespace triglyph {

struct IieSites {
  std::vector<std::uint32_t> points;      // that may be anchors, ascending
  std::vector<std::uint64_t> signatures;  // theirs
  std::vector<char> at_boundary;          // does the triangle have an edge without a neighbour?
};

// Returns the sites of a surface: the points whose keyed ring signature none within `rings` rings
// beats, or with 0 rings all points that have a signature; or those of the surface turned over.
// Parallel, O(halfedges) and the rings of the few points that beat their neighbours.
[[nodiscard]] IieSites find_sites(const Halfedges& halfedges, std::size_t points, int rings,
                                  std::uint64_t seed, RingOrder order = RingOrder::AsIs);

// Returns sites no two of which lie within `rings` rings of each other, as many as fit when points
// are taken in the order of their signatures over four rings, which are those of the mirror image.
// So far apart, nearly all of them can be units at a time, and a reader finds hardly any that
// carries no mark. Points of which many share a signature, as on a regular grid, are none: they
// would all vote for the same. What is done to a mesh changes only the sites near by, but a site
// more or less may change the next. O(points log points) and the rings of the sites.
[[nodiscard]] IieSites scatter_sites(const Halfedges& halfedges, std::size_t points, int rings,
                                     std::uint64_t seed);

// The points of the unit at a site; none moved: the site has no unit.
struct SiteUnit {
  std::vector<std::uint32_t> moved;
  std::vector<std::uint32_t> read;
};

// Returns the units at the sites that have one; `found` has an entry a site. O(points in them).
[[nodiscard]] UnitSet units_at(const IieSites& sites, std::span<const SiteUnit> found);

// Returns the points within so many rings of a point, itself among them, ascending. Returns nothing
// once accept(other) returns false for one of them, or if a fan is open. O(n log n) for n points.
template <typename Accept>
std::optional<std::vector<std::uint32_t>> accepted_points_within(const Halfedges& halfedges,
                                                                 std::uint32_t point, int rings,
                                                                 const Accept& accept) {
  std::vector<std::uint32_t> found{point};  // ascending in the part that earlier rings filled
  std::vector<std::uint32_t> last{point}, next;
  for (int ring = 0; ring < rings; ++ring) {
    next.clear();
    for (const std::uint32_t from : last) {
      bool all_accepted = true;
      const bool closed = visit_ring(halfedges, from, [&](std::uint32_t other) {
        all_accepted = all_accepted && accept(other);
        if (!std::binary_search(found.begin(), found.end(), other)) next.push_back(other);
      });
      if (!closed || !all_accepted) return std::nullopt;
    }
    std::sort(next.begin(), next.end());
    next.erase(std::unique(next.begin(), next.end()), next.end());
    const auto middle = static_cast<std::ptrdiff_t>(found.size());
    found.insert(found.end(), next.begin(), next.end());
    std::inplace_merge(found.begin(), found.begin() + middle, found.end());
    std::swap(last, next);
  }
  return found;
}

// Returns all points within so many rings of a point, itself among them, ascending; nothing if a
// fan is open.
[[nodiscard]] inline std::optional<std::vector<std::uint32_t>> points_within(
    const Halfedges& halfedges, std::uint32_t point, int rings) {
  return accepted_points_within(halfedges, point, rings, [](std::uint32_t) { return true; });
}

}  // namespace triglyph
