// Names for points by the connectivity around them: what no noise, rounding or motion changes.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/mesh/halfedges.h"

namespace triglyph {

// A keyed hash of each point's one-ring, two rings deep: of the valences around it in their cyclic
// order, and of theirs. The same wherever the ring starts, different for the mirrored order. 0
// where the two rings are not complete (at a boundary, or where several fans touch). O(halfedges),
// parallel. By colour refinement: Weisfeiler, Leman (1968).
[[nodiscard]] std::vector<std::uint64_t> ring_signatures(const Halfedges& halfedges,
                                                         std::size_t points, std::uint64_t seed);

// Calls visit(other) for the points next to `point`, which must have a single closed fan, counter-
// clockwise. Returns false, and stops, if the fan is open.
template <typename Visit>
bool visit_ring(const Halfedges& halfedges, std::uint32_t point, const Visit& visit) {
  const Halfedge first = halfedges.outgoing(point);
  if (first == kNoHalfedge) return false;
  Halfedge spoke = first;
  do {
    if (halfedges.is_boundary(spoke)) return false;
    visit(halfedges.to(spoke));
    spoke = halfedges.turned(spoke);
  } while (spoke != first);
  return true;
}

}  // namespace triglyph
