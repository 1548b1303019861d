// What every verb that works on many files shares: the options of a run, its supervision, its
// tallies and its last line.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "cli/options.h"
#include "cli/screen.h"
#include "manifests/ledger.h"
#include "manifests/run_context.h"

namespace triglyph {

// How many files may fail before the run is given up.
class FailureLimit {
 public:
  void add_to(CLI::App& verb);

  // Returns the number of failures that end the run, for `total` files; nothing: no limit.
  [[nodiscard]] std::optional<std::uint64_t> limit(std::size_t total) const;

 private:
  std::string most_;  // "10" or "5%"
  bool fail_fast_ = false;
};

// What a run is, for those who watch it.
struct RunName {
  std::string_view verb;
  std::vector<std::string_view> kinds;  // of results, as RunTally counts them
};

// The options --threads, --memory, --timeout, --max-failures, --fail-fast, --quiet, --progress,
// --trace, --metrics and --ledger.
class RunArguments {
 public:
  void add_to(CLI::App& verb);

  [[nodiscard]] bool is_quiet() const { return quiet_; }
  [[nodiscard]] bool has_bar() const { return !quiet_ && progress_ == "bar"; }
  [[nodiscard]] int threads() const { return machine_.threads(); }
  [[nodiscard]] const std::filesystem::path& ledger() const { return ledger_; }
  [[nodiscard]] std::optional<std::uint64_t> failure_limit(std::size_t total) const {
    return failures_.limit(total);
  }
  [[nodiscard]] RunContext context(const WorkOrder& order) const;

  // Runs `work` in a supervised process with the threads asked for, watches it as asked for, and
  // returns the exit code.
  [[nodiscard]] int supervised(const RunName& name,
                               const std::function<int(const WorkOrder&)>& work) const;

 private:
  MachineArguments machine_;
  FailureLimit failures_;
  double timeout_ = 0;
  bool quiet_ = false;
  std::string progress_ = "bar";
  std::filesystem::path trace_;
  std::filesystem::path metrics_;
  std::filesystem::path ledger_;
};

// Counts the results of a run by kind, over all its workers, with a progress bar; ends the run when
// too many failed; and says in one line on standard error what came of it.
class RunTally {
 public:
  // `kinds` names the results; `total` is the number of files, 0 if it is not known. The order and
  // its board must outlive the tally.
  RunTally(const RunArguments& arguments, const WorkOrder& order, std::size_t total,
           std::vector<std::string_view> kinds);

  // Likewise for files that are known; their sizes are asked for once in a run.
  RunTally(const RunArguments& arguments, const WorkOrder& order,
           std::span<const std::filesystem::path> files, std::vector<std::string_view> kinds);

  // To be called before anything else is printed, which the bar would mix with.
  void clear_bar() { bar_.clear(); }

  void count(std::size_t kind, bool failed, bool kept, const std::filesystem::path& input);

  // Prints the line unless the run is quiet, with the noun for one file or for several, and returns
  // the exit code.
  [[nodiscard]] int finish(std::string_view one, std::string_view several);

  // Likewise for a run; for a command on files that it names, which has no line, a failure is a
  // mistake of the command.
  [[nodiscard]] int end(bool is_run, std::string_view one, std::string_view several);

  // Returns the exit code: that of an interrupt, of a run that was given up or had failures, or
  // kDone.
  [[nodiscard]] int code() const;

  [[nodiscard]] bool gave_up() const { return board_.gave_up(); }
  [[nodiscard]] std::uint64_t failed() const;
  [[nodiscard]] std::uint64_t counted(std::size_t kind) const;

 private:
  const RunArguments& arguments_;
  RunBoard& board_;
  std::optional<std::uint64_t> limit_;
  std::vector<std::string_view> kinds_;
  ProgressBar bar_;
};

// A run in a ledger, from its begin to its end; does nothing where there is no ledger.
class LoggedRun {
 public:
  // Goes on with the run of an earlier worker if the order is not the first, or else with the
  // unfinished one, if any. The order and its board must outlive the object.
  LoggedRun(Ledger* ledger, const WorkOrder& order, std::string_view verb,
            std::optional<std::int64_t> unfinished = std::nullopt);
  [[nodiscard]] std::int64_t id() const { return id_; }

  // Notes what was found in the file whose result is being delivered; `result` is what --json
  // prints of it.
  void note(const std::filesystem::path& file, std::string_view status,
            const nlohmann::ordered_json& result) const;
  void end(int exit_code) const;

 private:
  Ledger* ledger_;
  const RunBoard& board_;
  std::int64_t id_ = 0;
};

// The arguments of this process as a shell would take them, for the ledger. To be set by main().
void set_command_line(int argc, char** argv);
[[nodiscard]] const std::string& command_line();

// Throws Error Unwritable if standard output does not take what is written to it.
void check_standard_output();

}  // namespace triglyph
