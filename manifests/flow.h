// Parallel processing of many files: a oneTBB flow graph that starts the largest waiting item that
// fits into the memory budget, runs its stages, and delivers the items in input order.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace triglyph {

// One file in the flow. Derived classes hold the data of the stages.
struct FlowItem {
  std::size_t index = 0;              // place in the run, from 0
  std::uint64_t memory_estimate = 0;  // most bytes that the item takes while it is processed

  virtual ~FlowItem() = default;
};

struct FlowOptions {
  // Bytes of memory for items in process; an item that needs more is processed alone.
  std::uint64_t memory_bytes = std::uint64_t{4} << 30;
};

struct Flow {
  // Returns the items in order, numbered from 0, and null at the end. Called by one thread at a
  // time. An exception ends the run after the items in process, and run_flow() rethrows it.
  std::function<std::unique_ptr<FlowItem>()> next;
  // Run one after another for an item, and in parallel for different items. Must not throw.
  std::vector<std::function<void(FlowItem&)>> stages;
  // Called in the order of the items, one call at a time. An exception cancels the run, and
  // run_flow() rethrows it.
  std::function<void(FlowItem&)> deliver;
};

// Runs the flow to its end. When `stop` becomes true, no further item is requested; items that were
// returned already still pass through the stages, which may check `stop` themselves.
void run_flow(const Flow& flow, const FlowOptions& options, const std::atomic<bool>& stop);

}  // namespace triglyph
