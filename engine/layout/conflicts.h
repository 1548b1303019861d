// Conflicts between candidates. The conflict graph stays implicit: a candidate's neighbours are
// found through the points that it shares with them, so memory is linear in the sizes of the
// candidates.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "engine/base/point_lists.h"

namespace triglyph {

enum class ConflictRule {
  ReadWrite,    // neither moves a point that the other reads: exact, so more units fit
  SharedPoint,  // no point in common, moved or read: the paper's rule
};

// Returns the names in the order of ConflictRule: "read-write", "shared-point".
[[nodiscard]] std::span<const std::string_view> conflict_names();
[[nodiscard]] std::string_view name_of(ConflictRule rule);

class Conflicts {
 public:
  // `moved` lists the points that each candidate may move, `read` those that its invariants depend
  // on, which include the former. They may be the same object; both must outlive the conflicts.
  // `points` is the number of points of the mesh. O(points + total size of the lists).
  Conflicts(const PointLists& moved, const PointLists& read, std::size_t points, ConflictRule rule);

  [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(moved_->size()); }
  [[nodiscard]] std::size_t points() const { return movers_.size(); }

  // Returns the points that no other chosen unit may move: those that the unit moves (ReadWrite),
  // or reads (SharedPoint).
  [[nodiscard]] std::span<const std::uint32_t> moved(std::uint32_t unit) const {
    return (*moved_)[unit];
  }

  // Returns the number of lists of units by point: the movers of each, and its readers where these
  // differ. Units interfere if the same list names them.
  [[nodiscard]] std::size_t list_count() const { return moved_ == read_ ? points() : 2 * points(); }

  // Returns the units on a list, ascending. Precondition: list < list_count().
  [[nodiscard]] std::span<const std::uint32_t> units_on(std::uint32_t list) const {
    const auto count = static_cast<std::uint32_t>(points());
    if (list >= count) return movers_[list - count];
    return moved_ == read_ ? movers_[list] : readers_[list];
  }

  // Calls visit(list) for the lists that name the units which interfere with `unit`; each of them
  // names `unit` too.
  template <typename Visit>
  void for_each_list(std::uint32_t unit, const Visit& visit) const {
    for (const std::uint32_t point : (*moved_)[unit]) visit(point);
    if (moved_ == read_) return;
    const auto count = static_cast<std::uint32_t>(points());
    for (const std::uint32_t point : (*read_)[unit]) visit(count + point);
  }

  // Calls visit(j) for every unit j that interferes with `unit`, possibly several times, and for
  // `unit` itself.
  template <typename Visit>
  void for_each_neighbour(std::uint32_t unit, const Visit& visit) const {
    for_each_list(unit, [&](std::uint32_t list) {
      for (const std::uint32_t other : units_on(list)) visit(other);
    });
  }

 private:
  const PointLists* moved_;
  const PointLists* read_;
  PointLists movers_;   // of each point, the units that move it
  PointLists readers_;  // of each point, the units that read it; empty if these are the same
};

}  // namespace triglyph
