// Signatures of points by the connectivity around them, which no noise, rounding or motion changes.
//
// Weisfeiler, Leman. The reduction of a graph to canonical form (1968): colour refinement.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/mesh/halfedges.h"

namespace triglyph {

// The order in which rings are read: as the surface has them, or as it has them whose triangles are
// wound the other way, or both, so that the one does not differ from the other.
enum class RingOrder { AsIs, TurnedOver, Either };

// Returns a keyed hash of the two rings around each point: of the valences in its ring in their
// cyclic order, and of those in the rings of its neighbours. The hash does not depend on where a
// ring starts, but differs for the other order unless it is
// of either. It is 0 where the two rings are not complete, at
// a boundary or where several fans touch. Parallel, O(halfedges).
[[nodiscard]] std::vector<std::uint64_t> ring_signatures(const Halfedges& halfedges,
                                                         std::size_t points, std::uint64_t seed,
                                                         RingOrder order = RingOrder::AsIs,
                                                         int rings = 2);

// Calls visit(other) for the neighbours of `point` counter-clockwise. Returns false, and stops, at
// a boundary. Precondition: the point has a single fan.
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
