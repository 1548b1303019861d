// What the engine asks of an embedding scheme: to be bound to a surface, and then a few calls on
// whole batches, so that the interface costs nothing and the inner loops belong to the scheme.
// Framework of Wang & Hu, CAGD 27 (2010), section 2.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/assignment/cost_matrix.h"
#include "engine/base/point_lists.h"
#include "engine/mesh/surface.h"
#include "engine/message/votes.h"
#include "engine/message/words.h"

namespace triglyph {

// Candidates for invariant units. Anchors ascend and none comes twice: where a place offers several
// units, the anchor says which. What a unit reads contains what it moves.
struct UnitSet {
  std::vector<std::uint32_t> anchors;  // scheme's own: triangle (TSQ), edge (AIE), point (IIE)
  PointLists moved;                    // points whose position the unit may change
  PointLists read;                     // points its invariants depend on; empty: the same as moved

  [[nodiscard]] std::size_t size() const { return anchors.size(); }
  [[nodiscard]] const PointLists& read_or_moved() const {
    return read.size() == moved.size() ? read : moved;
  }
};

// One unit and the word it is to carry.
struct Placement {
  std::uint32_t unit = 0;
  std::uint32_t word = 0;
};

struct Embedding {
  std::vector<Vec3> positions;
  std::vector<std::uint32_t> failed;  // indices of the placements that could not be made, ascending
};

// A scheme on one surface. It works out once what it needs of the surface, some of it when it is
// first asked for, and all calls share it; every call may be repeated, from several threads, and
// answers the same. The surface and the scheme must outlive it.
class BoundScheme {
 public:
  virtual ~BoundScheme() = default;

  // All candidates the marker can be embedded in.
  [[nodiscard]] virtual UnitSet find_units() const = 0;

  // Cost of every chosen unit (row) carrying every word (column); infinity where it cannot. The
  // units are those of find_units, or of a scheme bound to the same surface that differs in nothing
  // but the word code.
  [[nodiscard]] virtual CostMatrix costs(const UnitSet& units,
                                         std::span<const std::uint32_t> chosen,
                                         std::span<const Word> words) const = 0;

  // New positions with every placement made. Precondition: the units do not interfere.
  [[nodiscard]] virtual Embedding embed(const UnitSet& units, std::span<const Placement> placements,
                                        std::span<const Word> words) const = 0;

  // Everything in the mesh that shows the marker, by strictly ascending anchor, the anchors being
  // those of find_units. Blind: knows nothing of the original.
  [[nodiscard]] virtual std::vector<Reading> read() const = 0;

  // Where a unit lies: the points it depends on, as the surface now is, ascending. Of an anchor
  // that the surface does not have, or that no unit can stand at any more, what is left, or
  // nothing.
  [[nodiscard]] virtual PointLists points_of(std::span<const std::uint32_t> anchors) const = 0;

  // The same scheme on the same triangles and halfedges with other positions: answers as a fresh
  // bind to `moved` would, without working out again what depends on connectivity alone. Does not
  // need this bound scheme any more once it is made.
  [[nodiscard]] virtual std::unique_ptr<BoundScheme> moved_to(const Surface& moved) const = 0;

  // Width of a quantiser cell on this surface, model units: the step times the mean edge length.
  [[nodiscard]] virtual double cell_size() const = 0;
};

class Scheme {
 public:
  virtual ~Scheme() = default;

  // The surface and this scheme must outlive what is returned.
  [[nodiscard]] virtual std::unique_ptr<BoundScheme> bind(const Surface& surface) const = 0;
};

}  // namespace triglyph
