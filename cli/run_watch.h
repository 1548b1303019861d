// What a run shows while it lasts, from the supervisor's process: answers to SIGUSR1, progress as
// JSON, metrics and a trace.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "cli/run_arguments.h"
#include "engine/base/error.h"
#include "manifests/run_trace.h"

namespace triglyph {

struct WatchOptions {
  bool json_progress = false;
  std::filesystem::path trace;    // empty: none
  std::filesystem::path metrics;  // empty: none
};

class RunWatch {
 public:
  // Creates the trace. Throws Error Unwritable, also if a file of the name of the trace or of the
  // metrics is something else.
  RunWatch(const RunName& name, const WatchOptions& options);
  RunWatch(const RunWatch&) = delete;
  RunWatch& operator=(const RunWatch&) = delete;

  // Returns what the supervisor is to call; the watch must outlive it.
  [[nodiscard]] SupervisorEvents events();

  // Returns the order with the trace. To be called by the worker.
  [[nodiscard]] WorkOrder traced(const WorkOrder& order) const;

  // Ends the trace. Throws Error Unwritable if trace or metrics could not be written.
  void finish();

 private:
  void tick(const RunBoard& board, pid_t worker);
  void print_progress(const RunBoard& board, std::optional<int> exit_code) const;
  void write_metrics(const RunBoard& board, pid_t worker, std::optional<int> exit_code);

  RunName name_;
  WatchOptions options_;
  std::optional<RunTrace> trace_;
  std::optional<Error> metrics_error_;
  std::uint64_t workers_ = 0;
  std::uint64_t metrics_at_ = 0;  // milliseconds
};

}  // namespace triglyph
