// The explicit conflict graph, for solvers that visit the same neighbours many times.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/layout/conflicts.h"

namespace triglyph {

class ConflictGraph {
 public:
  // Lists the neighbours of every unit. O(sum of degrees) time and memory, 8 bytes per edge;
  // parallel.
  explicit ConflictGraph(const Conflicts& conflicts);

  [[nodiscard]] std::uint32_t size() const {
    return static_cast<std::uint32_t>(offsets_.size() - 1);
  }

  // Returns the units that interfere with `unit`, ascending, without duplicates.
  [[nodiscard]] std::span<const std::uint32_t> neighbours(std::uint32_t unit) const {
    return {neighbours_.data() + offsets_[unit], neighbours_.data() + offsets_[unit + 1]};
  }

 private:
  std::vector<std::size_t> offsets_{0};
  std::vector<std::uint32_t> neighbours_;
};

// A partition of the units into blocks that can be searched in parallel. Blocks are connected, have
// at most `size` units, and are grown breadth first from a start that the seed selects.
class GraphBlocks {
 public:
  GraphBlocks() = default;

  // O(sum of degrees).
  GraphBlocks(const ConflictGraph& graph, std::uint32_t size, std::uint64_t seed);

  [[nodiscard]] std::size_t size() const { return offsets_.size() - 1; }
  [[nodiscard]] std::span<const std::uint32_t> units(std::size_t block) const {
    return {units_.data() + offsets_[block], units_.data() + offsets_[block + 1]};
  }

  // Returns whether all neighbours are in the unit's own block.
  [[nodiscard]] bool is_interior(std::uint32_t unit) const { return interior_[unit] != 0; }

 private:
  std::vector<std::size_t> offsets_{0};
  std::vector<std::uint32_t> units_;
  std::vector<char> interior_;
};

}  // namespace triglyph
