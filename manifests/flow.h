// Parallel processing of many files: a oneTBB flow graph that starts the largest waiting item that
// fits into the memory budget, processes it, and delivers the items in input order.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string_view>
#include <vector>

#include "manifests/run_trace.h"

namespace triglyph {

// One file in the flow. Derived classes hold the data of the stages.
struct FlowItem {
  std::size_t index = 0;              // place in the run, from 0
  std::uint64_t memory_estimate = 0;  // most bytes that the item takes while it is processed
  TraceTime announced = {};           // when it began to wait for memory; only with a trace

  virtual ~FlowItem() = default;
  // Returns what a trace calls the item.
  [[nodiscard]] virtual std::string_view name() const { return {}; }
};

struct FlowOptions {
  // Bytes of memory for items in process; an item that needs more is processed alone.
  std::uint64_t memory_bytes = std::uint64_t{4} << 30;
  // Gets the time of every item on every thread, what it waited for, and how many items and bytes
  // are on their way; null: nothing is traced.
  const RunTrace* trace = nullptr;
};

struct Flow {
  // Returns the items in order, numbered from 0, and null at the end. Called by one thread at a
  // time. An exception ends the run after the items in process, and run_flow() rethrows it.
  std::function<std::unique_ptr<FlowItem>()> next;
  // Processes an item; runs in parallel for different items. Must not throw.
  std::function<void(FlowItem&)> work;
  // Both are called after the work, one call at a time, by the thread that did the work:
  // `completed` at once, `deliver` in the order of the items. An exception cancels the run, and
  // run_flow() rethrows it. `completed` may be empty.
  std::function<void(FlowItem&)> completed;
  std::function<void(FlowItem&)> deliver;
};

// Runs the flow to its end. When `stop` becomes true, no further item is requested; items that were
// returned already are still processed; the work may check `stop` itself.
void run_flow(const Flow& flow, const FlowOptions& options, const std::atomic<bool>& stop);

}  // namespace triglyph
