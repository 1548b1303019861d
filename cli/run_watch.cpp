#include "cli/run_watch.h"

#include <csignal>
#include <cstring>
#include <fstream>
#include <iostream>

#include <sys/stat.h>
#include <unistd.h>

#include "cli/app.h"
#include "cli/metrics_text.h"
#include "engine/base/error.h"
#include "engine/base/output_file.h"
#include "manifests/json_line.h"

namespace triglyph {
namespace {

// Milliseconds between two states of the file of metrics: collectors look every 15 s or less often.
constexpr std::uint64_t kMetricsPeriod = 5000;

constexpr std::string_view kMetricsBegin = "# TYPE triglyph_";

// Refuses to replace what is no file of metrics.
void check_may_hold_metrics(const std::filesystem::path& path) {
  struct stat status {};
  if (stat(path.c_str(), &status) != 0 || (S_ISREG(status.st_mode) && status.st_size == 0)) return;
  std::string begin(kMetricsBegin.size(), '\0');
  if (S_ISREG(status.st_mode)) {
    std::ifstream(path, std::ios::binary).read(begin.data(), static_cast<long>(begin.size()));
  }
  if (begin == kMetricsBegin) return;
  throw Error(ErrorCode::Unwritable, path, "", "is there already, and no file of metrics");
}

std::uint64_t resident_bytes_of(pid_t process) {
  std::uint64_t pages = 0;
  std::ifstream statistics("/proc/" + std::to_string(process) + "/statm");
  if (!(statistics >> pages >> pages)) return 0;
  return pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

// Prints a line in one go, over a bar if there may be one.
void print_status(const std::string& line) {
  std::cerr << (isatty(STDERR_FILENO) == 1 ? "\r\033[K" : "") + line + "\n" << std::flush;
}

}  // namespace

RunWatch::RunWatch(const RunName& name, const WatchOptions& options)
    : name_(name), options_(options) {
  if (!options.metrics.empty()) check_may_hold_metrics(options.metrics);
  if (!options.trace.empty()) trace_.emplace(options.trace);
}

SupervisorEvents RunWatch::events() {
  SupervisorEvents events;
  events.started = [this](pid_t worker) {
    ++workers_;
    if (trace_) trace_->instant("worker started", "process " + std::to_string(worker));
  };
  events.died = [this](const RunBoard& board, int signal) {
    if (!trace_) return;
    std::string detail = "signal " + std::to_string(signal) + " (" + strsignal(signal) + ")";
    for (const ItemInWork& item : board.items_in_work()) detail += "; in work: " + item.name;
    trace_->instant("worker died", detail);
  };
  events.asked = [this](const RunBoard& board, pid_t) {
    print_status("triglyph: " + std::string(name_.verb) + ": " + text_of(progress_of(board)));
  };
  if (options_.json_progress || !options_.metrics.empty()) {
    events.period = 1;
    events.tick = [this](const RunBoard& board, pid_t worker) { tick(board, worker); };
  }
  events.ended = [this](const RunBoard& board, std::optional<int> exit_code) {
    const bool is_fatal = !exit_code && !board.stop();
    const int code = is_fatal ? kFatal : exit_code.value_or(kInterrupted);
    if (options_.json_progress) print_progress(board, code);
    if (!options_.metrics.empty()) write_metrics(board, 0, code);
  };
  return events;
}

void RunWatch::tick(const RunBoard& board, pid_t worker) {
  if (options_.json_progress) print_progress(board, std::nullopt);
  const std::uint64_t now = milliseconds_now();
  if (options_.metrics.empty() || (metrics_at_ > 0 && now - metrics_at_ < kMetricsPeriod)) return;
  metrics_at_ = now;
  write_metrics(board, worker, std::nullopt);
}

void RunWatch::print_progress(const RunBoard& board, std::optional<int> exit_code) const {
  nlohmann::ordered_json json = json_of(progress_of(board), name_.verb);
  for (std::size_t kind = 0; kind < name_.kinds.size(); ++kind) {
    const std::uint64_t count = board.counters[kind];
    if (count > 0) json["results"][std::string(name_.kinds[kind])] = count;
  }
  json["exit_code"] = nullptr;
  if (exit_code) json["exit_code"] = *exit_code;
  std::cerr << to_line(json) << std::flush;
}

void RunWatch::write_metrics(const RunBoard& board, pid_t worker, std::optional<int> exit_code) {
  RunMetrics metrics;
  metrics.progress = progress_of(board);
  for (std::size_t kind = 0; kind < name_.kinds.size(); ++kind) {
    metrics.results.push_back(board.counters[kind]);
  }
  metrics.workers = workers_;
  if (worker > 0) metrics.resident_bytes = resident_bytes_of(worker);
  metrics.exit_code = exit_code;
  try {
    OutputFile file(options_.metrics);
    file.write(metrics_text(name_, metrics));
    file.commit();
    metrics_error_.reset();
  } catch (const Error& error) {  // the run is worth more than its metrics
    metrics_error_.emplace(error);
  }
}

WorkOrder RunWatch::traced(const WorkOrder& order) const {
  WorkOrder traced = order;
  if (!trace_) return traced;
  trace_->name_process(order.only       ? "worker that tries a suspect alone"
                       : order.is_first ? "worker"
                                        : "worker, after one that died");
  traced.trace = &*trace_;
  return traced;
}

void RunWatch::finish() {
  if (trace_) trace_->finish();
  if (metrics_error_) throw Error(*metrics_error_);
}

}  // namespace triglyph
