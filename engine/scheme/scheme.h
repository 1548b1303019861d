// The interface of an embedding scheme. A scheme is bound to a surface and then called for whole
// batches of units: virtual calls cost nothing then, and the inner loops belong to the scheme.
//
// This work is based on:
// Wang, Hu. Optimization approach for 3D model watermarking by linear binary programming. CAGD 27
// (2010), section 2.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "engine/assignment/cost_matrix.h"
#include "engine/base/point_lists.h"
#include "engine/mesh/surface.h"
#include "engine/message/votes.h"
#include "engine/message/words.h"

namespace triglyph {

// The candidates for invariant units. Anchors ascend strictly: where a place offers several units,
// the anchor tells them apart. The points that a unit reads include those that it moves.
struct UnitSet {
  std::vector<std::uint32_t> anchors;  // triangle (TSQ), edge and grouping (AIE), point (IIE)
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

// A scheme bound to one surface. What it computes of the surface alone it computes once, at the
// latest when a call first needs it. Every call may be repeated, from several threads at a time,
// and returns the same. The mesh, the halfedges and the scheme must outlive it.
class BoundScheme {
 public:
  virtual ~BoundScheme() = default;

  // Returns all candidates in which the marker can be embedded.
  [[nodiscard]] virtual UnitSet find_units() const = 0;

  // Returns what each chosen unit (row) costs under each word (column), model units; kInfeasible
  // where the unit cannot carry the word. `chosen` are indices into `units`, which are those of
  // find_units, or of a scheme bound to the same surface that differs in the word code alone.
  [[nodiscard]] virtual CostMatrix costs(const UnitSet& units,
                                         std::span<const std::uint32_t> chosen,
                                         std::span<const Word> words) const = 0;

  // Returns the positions of all points with every placement made that can be made. Precondition:
  // the units do not interfere.
  [[nodiscard]] virtual Embedding embed(const UnitSet& units, std::span<const Placement> placements,
                                        std::span<const Word> words) const = 0;

  // Returns the readings of all units that show the marker, by strictly ascending anchor; anchors
  // number the same places as in find_units. Reading is blind: it knows nothing of the original.
  [[nodiscard]] virtual std::vector<Reading> read() const = 0;

  // Returns what read() would return of the surface before it was turned over: its triangles wound
  // the other way, or its shape mirrored, or both. One list for each of these that the scheme can
  // tell from another and from read(); anchors number the same places. At most as many times the
  // cost of read() as there are lists.
  [[nodiscard]] virtual std::vector<std::vector<Reading>> read_turned_over() const = 0;

  // Returns those of the readings of read() at one in `one_in` places, drawn by lot; nothing for
  // schemes of which reading everything costs little beside marking, or is needed in any case.
  [[nodiscard]] virtual std::optional<std::vector<Reading>> read_sample(
      std::uint32_t /*one_in*/) const {
    return std::nullopt;
  }

  // Returns those of the readings of read() whose anchors are among `anchors`, which ascend
  // strictly. An anchor that the surface does not have is never read. TSQ and AIE take
  // O(anchors); IIE takes as long as read(), since its readings depend on each other.
  [[nodiscard]] virtual std::vector<Reading> read_at(
      std::span<const std::uint32_t> anchors) const = 0;

  // Returns for each anchor the points on which its unit depends, ascending. Where the surface has
  // no such unit any more the list holds what is left of it, or nothing.
  [[nodiscard]] virtual PointLists points_of(std::span<const std::uint32_t> anchors) const = 0;

  // Binds the scheme to the same triangles and halfedges with other positions. The result equals
  // that of Scheme::bind(moved), but what depends on connectivity alone is not computed again. It
  // does not refer to this bound scheme.
  [[nodiscard]] virtual std::unique_ptr<BoundScheme> moved_to(const Surface& moved) const = 0;

  // Returns the width of a quantiser cell on this surface, model units: the step times the mean
  // edge length.
  [[nodiscard]] virtual double cell_size() const = 0;
};

class Scheme {
 public:
  virtual ~Scheme() = default;

  // Binds the scheme to a surface. Its mesh and halfedges and this scheme must outlive the result.
  [[nodiscard]] virtual std::unique_ptr<BoundScheme> bind(const Surface& surface) const = 0;
};

}  // namespace triglyph
