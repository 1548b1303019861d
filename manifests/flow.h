// Work on many files at once: a oneTBB flow graph that starts the largest waiting item that fits
// into the memory budget, runs its stages, and delivers the items in the order they came.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace triglyph {

// One file on its way. Derive from it to carry what the stages need.
struct FlowItem {
  std::size_t index = 0;              // place in the run, from 0
  std::uint64_t memory_estimate = 0;  // bytes the item needs at most while it is worked on

  virtual ~FlowItem() = default;
};

struct FlowOptions {
  // Bytes of memory for items being worked on; an item that needs more goes alone.
  std::uint64_t memory_bytes = std::uint64_t{4} << 30;
};

struct Flow {
  // Returns the items in order, numbered from 0, and null at the end; called one at a time. What it
  // throws ends the run after the items that are already in work, and is rethrown by run_flow.
  std::function<std::unique_ptr<FlowItem>()> next;
  // Run one after another for an item; stages of different items run at the same time. They must
  // not throw.
  std::vector<std::function<void(FlowItem&)>> stages;
  // Called in the order of the items, one call at a time. What it throws cancels the run and is
  // rethrown by run_flow.
  std::function<void(FlowItem&)> deliver;
};

// Runs the flow to its end. When `stop` becomes true no further item is asked for; those already
// known still pass through the stages, which may look at `stop` themselves.
void run_flow(const Flow& flow, const FlowOptions& options, const std::atomic<bool>& stop);

}  // namespace triglyph
