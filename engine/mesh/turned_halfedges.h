// The connectivity of a surface whose triangles are wound the other way, as a view of the halfedges
// that there are: every halfedge runs backwards, and the face to its left is the same. Nothing is
// copied.
#pragma once

#include "engine/mesh/halfedges.h"

namespace triglyph {

// Offers those of the functions of Halfedges that walks need. The halfedges must outlive it.
class TurnedHalfedges {
 public:
  explicit TurnedHalfedges(const Halfedges& halfedges) : halfedges_(halfedges) {}

  [[nodiscard]] Halfedge next(Halfedge halfedge) const { return halfedges_.previous(halfedge); }
  [[nodiscard]] Halfedge previous(Halfedge halfedge) const { return halfedges_.next(halfedge); }
  [[nodiscard]] Halfedge opposite(Halfedge halfedge) const { return halfedges_.opposite(halfedge); }
  // Returns the next halfedge, counter-clockwise in the turned surface, that leaves the same point.
  [[nodiscard]] Halfedge turned(Halfedge halfedge) const { return opposite(previous(halfedge)); }
  [[nodiscard]] bool is_boundary(Halfedge halfedge) const {
    return halfedges_.is_boundary(halfedge);
  }
  [[nodiscard]] std::uint32_t from(Halfedge halfedge) const { return halfedges_.to(halfedge); }
  [[nodiscard]] std::uint32_t to(Halfedge halfedge) const { return halfedges_.from(halfedge); }

 private:
  const Halfedges& halfedges_;
};

}  // namespace triglyph
