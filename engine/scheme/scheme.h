// What the engine asks of an embedding scheme: four calls on whole batches, so that the interface
// costs nothing and the inner loops belong to the scheme.
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

class Scheme {
 public:
  virtual ~Scheme() = default;

  // All candidates the marker can be embedded in.
  [[nodiscard]] virtual UnitSet find_units(const Surface& surface) const = 0;

  // Cost of every chosen unit (row) carrying every word (column); infinity where it cannot.
  [[nodiscard]] virtual CostMatrix costs(const Surface& surface, const UnitSet& units,
                                         std::span<const std::uint32_t> chosen,
                                         std::span<const Word> words) const = 0;

  // New positions with every placement made. Precondition: the units do not interfere.
  [[nodiscard]] virtual Embedding embed(const Surface& surface, const UnitSet& units,
                                        std::span<const Placement> placements,
                                        std::span<const Word> words) const = 0;

  // Everything in the mesh that shows the marker, by strictly ascending anchor, the anchors being
  // those of find_units. Blind: knows nothing of the original.
  [[nodiscard]] virtual std::vector<Reading> read(const Surface& surface) const = 0;

  // Where a unit lies: the points it depends on, as the surface now is, ascending. Of an anchor
  // that the surface does not have, or that no unit can stand at any more, what is left, or
  // nothing.
  [[nodiscard]] virtual PointLists points_of(const Surface& surface,
                                             std::span<const std::uint32_t> anchors) const = 0;
};

}  // namespace triglyph
