#include "cli/run_arguments.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <iostream>

#include "cli/app.h"
#include "cli/progress.h"
#include "cli/run_watch.h"
#include "cli/screen.h"
#include "engine/base/error.h"
#include "engine/base/parallel.h"
#include "manifests/json_line.h"
#include "manifests/resume.h"

namespace triglyph {
namespace {

std::string& stored_command_line() {
  static std::string text;
  return text;
}

std::string quoted(const std::string& word) {
  const bool is_plain = !word.empty() && std::all_of(word.begin(), word.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 ||
           std::string_view("-_./=:,@%+").find(static_cast<char>(c)) != std::string_view::npos;
  });
  if (is_plain) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

std::string rounded(double value, const char* unit) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), value < 10 ? "%.2f %s" : "%.0f %s", value, unit);
  return text.data();
}

}  // namespace

void FailureLimit::add_to(CLI::App& verb) {
  verb.add_option("--max-failures", most_,
                  "Give the run up when more files fail: a number, or a share such as 5% "
                  "(default: no limit)")
      ->type_name("N|P%");
  verb.add_flag("--fail-fast", fail_fast_, "Give the run up at the first file that fails");
}

std::optional<std::uint64_t> FailureLimit::limit(std::size_t total) const {
  if (fail_fast_) return 0;
  if (most_.empty()) return std::nullopt;
  const bool is_share = most_.back() == '%';
  const std::string number = is_share ? most_.substr(0, most_.size() - 1) : most_;
  std::size_t read = 0;
  double value = -1;
  try {
    value = std::stod(number, &read);
  } catch (const std::exception&) {
    read = 0;
  }
  const bool is_valid = read == number.size() && read > 0 && value >= 0 && std::isfinite(value) &&
                        (is_share ? value <= 100 : value == std::floor(value) && value < 1e15);
  if (!is_valid) {
    throw Error(ErrorCode::Usage, {}, "",
                "--max-failures is a whole number or a share from 0% to 100%, not " + most_);
  }
  return static_cast<std::uint64_t>(is_share ? value / 100 * static_cast<double>(total) : value);
}

void RunArguments::add_to(CLI::App& verb) {
  machine_.add_threads_to(verb);
  machine_.add_memory_to(verb);
  verb.add_option("--timeout", timeout_,
                  "Give a file up that takes longer than this many seconds (default: 0, no limit)")
      ->check(CLI::Range(0.0, 1e6).description(""))
      ->type_name("SECONDS");
  failures_.add_to(verb);
  verb.add_flag("--quiet", quiet_, "Print no table, no progress and no summary, only errors");
  verb.add_option("--progress", progress_,
                  "Say how far the run is: a bar, if standard error is a terminal; JSON objects, "
                  "one a second on standard error; or nothing (default: bar)")
      ->check(CLI::IsMember({"bar", "json", "none"}).description(""))
      ->type_name("bar|json|none");
  verb.add_option("--trace", trace_,
                  "Write what every thread does, and when, to this file, which Perfetto and "
                  "chrome://tracing show")
      ->type_name("FILE");
  verb.add_option("--metrics", metrics_,
                  "Keep the state of the run in this file, as OpenMetrics, renewed every five "
                  "seconds")
      ->type_name("FILE");
  verb.add_option("--ledger", ledger_, "Remember the run in this file")->type_name("FILE");
}

RunContext RunArguments::context(const WorkOrder& order) const {
  RunContext context;
  context.flow.memory_bytes = machine_.memory_bytes();
  context.flow.trace = order.trace;
  context.order = &order;
  return context;
}

int RunArguments::supervised(const RunName& name,
                             const std::function<int(const WorkOrder&)>& work) const {
  (void)failure_limit(100);  // a mistake is to be known before the run
  RunWatch watch(name, {progress_ == "json", trace_, metrics_});
  const std::optional<int> code = supervise(
      [&](const WorkOrder& order) {
        std::signal(SIGPIPE, SIG_IGN);  // what cannot be written is an error of its own
        const WorkOrder watched = watch.traced(order);
        int result = kFatal;
        with_threads(machine_.threads(), [&] { result = work(watched); });
        check_standard_output();
        return result;
      },
      timeout_, watch.events());
  watch.finish();
  if (code) return *code;
  std::cerr << "triglyph: interrupted\n";
  return kInterrupted;
}

RunTally::RunTally(const RunArguments& arguments, const WorkOrder& order, std::size_t total,
                   std::vector<std::string_view> kinds)
    : arguments_(arguments),
      board_(*order.board),
      limit_(arguments.failure_limit(total)),
      kinds_(std::move(kinds)),
      bar_(arguments.has_bar()) {
  check(kinds_.size() <= kMostKinds, "a counter for every kind of result");
  if (!order.is_first) return;
  board_.counters[kStarted] = milliseconds_now();
  board_.total = total;
}

RunTally::RunTally(const RunArguments& arguments, const WorkOrder& order,
                   std::span<const std::filesystem::path> files,
                   std::vector<std::string_view> kinds)
    : RunTally(arguments, order, files.size(), std::move(kinds)) {
  if (!order.is_first) return;
  for (const std::filesystem::path& file : files) board_.total_bytes += bytes_of_file(file);
}

void RunTally::count(std::size_t kind, bool failed, bool kept, const std::filesystem::path& input) {
  ++board_.counters[kind];
  if (kept) ++board_.counters[kKept];
  const std::uint64_t bytes = bytes_of_file(input);
  board_.counters[kBytes] += bytes;
  if (kept) board_.counters[kKeptBytes] += bytes;
  if (failed && ++board_.counters[kFailed] > limit_.value_or(~std::uint64_t{0})) board_.give_up();
  bar_.advance([this] { return progress_of(board_); });
}

std::uint64_t RunTally::failed() const {
  return board_.counters[kFailed];
}

std::uint64_t RunTally::counted(std::size_t kind) const {
  return board_.counters[kind];
}

int RunTally::finish(std::string_view one, std::string_view several) {
  bar_.clear();
  std::uint64_t all = 0;
  std::string parts;
  for (std::size_t kind = 0; kind < kinds_.size(); ++kind) {
    const std::uint64_t count = counted(kind);
    if (count == 0) continue;
    all += count;
    parts += (parts.empty() ? "" : ", ") + std::to_string(count) + " " + std::string(kinds_[kind]);
  }
  const double seconds =
      std::max(1e-3, static_cast<double>(milliseconds_now() - board_.counters[kStarted]) / 1000);
  const double megabytes = static_cast<double>(board_.counters[kBytes]) / 1e6;
  std::string line = std::to_string(all) + " " + std::string(all == 1 ? one : several);
  if (!parts.empty()) line += ": " + parts;
  if (const std::uint64_t kept = board_.counters[kKept]; kept > 0) {
    line += " (" + std::to_string(kept) + " as an earlier run left them)";
  }
  line += "; " + rounded(seconds, "s") + ", " + rounded(megabytes / seconds, "MB/s");
  if (!arguments_.is_quiet()) std::cerr << "triglyph: " << line << "\n";
  if (board_.gave_up()) {
    std::cerr << "triglyph: given up after " << failed()
              << " failures; the same command goes on from here\n";
  }
  return code();
}

int RunTally::end(bool is_run, std::string_view one, std::string_view several) {
  if (is_run) return finish(one, several);
  return code() == kSomeFailed ? kUsageError : code();
}

int RunTally::code() const {
  if (board_.gave_up()) return kSomeFailed;
  if (board_.stop()) return kInterrupted;
  return failed() > 0 ? kSomeFailed : kDone;
}

LoggedRun::LoggedRun(Ledger* ledger, const WorkOrder& order, std::string_view verb,
                     std::optional<std::int64_t> unfinished)
    : ledger_(ledger), board_(*order.board) {
  if (ledger_ == nullptr) return;
  std::atomic<std::uint64_t>& known = order.board->counters[kRunId];
  if (known == 0 && unfinished) known = static_cast<std::uint64_t>(*unfinished);
  if (known == 0) {
    LedgerRun run;
    run.verb = verb;
    run.command = command_line();
    std::error_code ignored;
    run.directory = std::filesystem::current_path(ignored).string();
    run.version = TRIGLYPH_VERSION;
    known = static_cast<std::uint64_t>(ledger_->begin_run(run));
  }
  id_ = static_cast<std::int64_t>(known.load());
}

void LoggedRun::note(const std::filesystem::path& file, std::string_view status,
                     const nlohmann::ordered_json& result) const {
  if (ledger_ == nullptr) return;
  std::string line = to_line(result);
  line.pop_back();  // the newline
  ledger_->note({.run = id_,
                 .place = board_.delivered,  // as many as came before
                 .file = canonical_name(file),
                 .status = std::string(status),
                 .line = std::move(line)});
}

void LoggedRun::end(int exit_code) const {
  if (ledger_ == nullptr) return;
  const char* outcome = "failed";
  if (exit_code == kDone) outcome = "done";
  if (exit_code == kSomeFailed || exit_code == kNoMark) outcome = "some failed";
  if (exit_code == kInterrupted) outcome = "interrupted";
  ledger_->end_run(id_, outcome);
}

void set_command_line(int argc, char** argv) {
  std::string& text = stored_command_line();
  text.clear();
  for (int i = 0; i < argc; ++i) text += (i == 0 ? "" : " ") + quoted(argv[i]);
}

const std::string& command_line() {
  return stored_command_line();
}

void check_standard_output() {
  errno = 0;
  std::cout.flush();
  if (std::cout) return;
  throw Error(ErrorCode::Unwritable, {}, "",
              "standard output: " + (errno == 0 ? "it cannot be written" : system_reason(errno)));
}

}  // namespace triglyph
