// Which candidates interfere. The conflict graph stays implicit: a candidate's neighbours are found
// through the points it shares with them, so memory is linear in the candidates' sizes.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "engine/base/point_lists.h"

namespace triglyph {

enum class ConflictRule {
  ReadWrite,    // one may not move what the other reads; exact, and leaves room for more units
  SharedPoint,  // the paper's: no point in common, moved or read
};

// Names by ConflictRule: "read-write", "shared-point".
[[nodiscard]] std::span<const std::string_view> conflict_names();
[[nodiscard]] std::string_view name_of(ConflictRule rule);

class Conflicts {
 public:
  // `moved` and `read`: points that each candidate may move, and those that its invariants depend
  // on, which contain the former; they may be one object, and both must outlive the conflicts.
  // O(total size of the lists).
  Conflicts(const PointLists& moved, const PointLists& read, std::size_t points, ConflictRule rule);

  [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(moved_->size()); }
  [[nodiscard]] std::size_t points() const { return movers_.size(); }

  // Points that unit i alone may occupy: what it moves (ReadWrite) or reads (SharedPoint).
  [[nodiscard]] std::span<const std::uint32_t> moved(std::uint32_t unit) const {
    return (*moved_)[unit];
  }

  // The units that interfere with one are written in lists which many units share: those that read
  // a point it moves, and those that move a point it reads. The lists are numbered from 0 to
  // list_count() - 1.
  [[nodiscard]] std::size_t list_count() const { return moved_ == read_ ? points() : 2 * points(); }

  // Units on a list, ascending.
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

  // Calls visit(j) for every unit j that interferes with `unit`; some more than once, and `unit`
  // itself too.
  template <typename Visit>
  void for_each_neighbour(std::uint32_t unit, const Visit& visit) const {
    for_each_list(unit, [&](std::uint32_t list) {
      for (const std::uint32_t other : units_on(list)) visit(other);
    });
  }

 private:
  const PointLists* moved_;
  const PointLists* read_;
  PointLists movers_;   // units that move a point
  PointLists readers_;  // units that read a point; empty if the same
};

}  // namespace triglyph
