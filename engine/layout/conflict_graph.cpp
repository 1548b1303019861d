#include "engine/layout/conflict_graph.h"

#include <algorithm>

#include "engine/base/parallel.h"
#include "engine/base/random.h"
#include "engine/base/stop.h"

namespace triglyph {
namespace {

constexpr std::uint32_t kNoIndex = 0xffffffff;

}  // namespace

ConflictGraph::ConflictGraph(const Conflicts& conflicts) : offsets_(conflicts.size() + 1, 0) {
  neighbours_ = parallel_collect<std::uint32_t>(
      conflicts.size(), [&](std::size_t i, std::vector<std::uint32_t>& out) {
        const auto unit = static_cast<std::uint32_t>(i);
        const auto first = static_cast<std::ptrdiff_t>(out.size());
        conflicts.for_each_neighbour(unit, [&](std::uint32_t other) {
          if (other != unit) out.push_back(other);
        });
        std::sort(out.begin() + first, out.end());
        out.erase(std::unique(out.begin() + first, out.end()), out.end());
        offsets_[i + 1] = out.size() - static_cast<std::size_t>(first);
      });
  for (std::size_t i = 1; i < offsets_.size(); ++i) offsets_[i] += offsets_[i - 1];
}

GraphBlocks::GraphBlocks(const ConflictGraph& graph, std::uint32_t size, std::uint64_t seed)
    : interior_(graph.size(), 1) {
  const std::uint32_t count = graph.size();
  units_.reserve(count);
  std::vector<std::uint32_t> block_of(count, kNoIndex);
  const auto start = static_cast<std::uint32_t>(count == 0 ? 0 : random_bits(seed, 0, 0) % count);
  // units_ is the queue of the breadth-first search; a full block is followed by one beside it
  for (std::uint32_t i = 0; i < count; ++i) {
    std::uint32_t root = (start + i) % count;
    while (root != kNoIndex && block_of[root] == kNoIndex) {
      stop_point();
      const auto block = static_cast<std::uint32_t>(this->size());
      const std::size_t first = units_.size();
      block_of[root] = block;
      units_.push_back(root);
      std::uint32_t beside = kNoIndex;
      for (std::size_t next = first; next < units_.size(); ++next) {
        for (const std::uint32_t other : graph.neighbours(units_[next])) {
          if (block_of[other] != kNoIndex) continue;
          if (units_.size() - first == size) {
            beside = other;
            break;
          }
          block_of[other] = block;
          units_.push_back(other);
        }
      }
      offsets_.push_back(units_.size());
      root = beside;
    }
  }
  parallel_for(
      count,
      [&](std::size_t unit) {
        for (const std::uint32_t other : graph.neighbours(static_cast<std::uint32_t>(unit))) {
          if (block_of[other] != block_of[unit]) interior_[unit] = 0;
        }
      },
      kBlock);
}

}  // namespace triglyph
