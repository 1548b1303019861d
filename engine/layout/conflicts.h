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

  // Calls visit(j) for every unit j that interferes with `unit`; some more than once, and `unit`
  // itself too.
  template <typename Visit>
  void for_each_neighbour(std::uint32_t unit, const Visit& visit) const {
    for (const std::uint32_t point : (*moved_)[unit]) {
      for (const std::uint32_t other : readers()[point]) visit(other);
    }
    if (moved_ == read_) return;
    for (const std::uint32_t point : (*read_)[unit]) {
      for (const std::uint32_t other : movers_[point]) visit(other);
    }
  }

 private:
  [[nodiscard]] const PointLists& readers() const { return moved_ == read_ ? movers_ : readers_; }

  const PointLists* moved_;
  const PointLists* read_;
  PointLists movers_;   // units that move a point
  PointLists readers_;  // units that read a point; empty if the same
};

}  // namespace triglyph
