#include <cmath>
#include <ctime>
#include <iostream>
#include <memory>

#include "cli/app.h"
#include "cli/junit_report.h"
#include "cli/options.h"
#include "cli/run_arguments.h"
#include "cli/verbs.h"
#include "engine/base/error.h"
#include "engine/base/text.h"
#include "manifests/json_line.h"
#include "manifests/resume.h"
#include "manifests/shard.h"
#include "manifests/sweep.h"

namespace triglyph {
namespace {

namespace fs = std::filesystem;

struct SweepArguments {
  std::vector<std::string> inputs;
  std::string subset;       // "3/7"
  std::string sample;       // "5%"
  double max_duration = 0;  // seconds; 0: no limit
  double younger_than = 0;  // seconds; 0: any age
  std::vector<fs::path> search;
  bool full = false;
  bool accept = false;
  bool restart = false;
  bool all = false;
  bool json = false;
  fs::path junit;
  KeysArgument keys;
  RunArguments run;
};

double read_sample(const std::string& text) {
  if (text.empty()) return 1;
  std::size_t end = 0;
  double percent = 0;
  try {
    percent = std::stod(text, &end);
  } catch (const std::exception&) {
    end = 0;
  }
  if (end == 0 || text.substr(end) != "%" || !(percent > 0 && percent <= 100)) {
    throw Error(ErrorCode::Usage, {}, "", "--sample is a share such as 5%, not " + text);
  }
  return percent / 100;
}

// Returns the time so many seconds ago as the ledger writes it.
std::string utc_before(double seconds) {
  const std::time_t then = std::time(nullptr) - static_cast<std::time_t>(seconds);
  std::tm parts{};
  gmtime_r(&then, &parts);
  std::string text(32, '\0');
  text.resize(std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts));
  return text;
}

SweepOptions options_of(const SweepArguments& arguments) {
  SweepOptions options;
  for (const std::string& name : arguments.inputs) {
    std::string below = canonical_name(name);
    if (below.size() > 1 && below.ends_with('/')) below.pop_back();
    options.selection.below.push_back(std::move(below));
  }
  if (!arguments.subset.empty()) {
    options.selection.part = Shard::parsed(arguments.subset, "--subset");
  }
  options.selection.sample = read_sample(arguments.sample);
  if (arguments.younger_than > 0) {
    options.selection.marked_since = utc_before(arguments.younger_than);
  }
  for (const fs::path& folder : arguments.search) {
    std::error_code ignored;
    if (!fs::is_directory(folder, ignored)) {
      throw Error(ErrorCode::Unreadable, folder, "", "is no folder to search in");
    }
  }
  options.search = arguments.search;
  options.reads_all = arguments.full;
  options.accepts = arguments.accept;
  if (arguments.max_duration > 0) {
    options.deadline = std::chrono::steady_clock::now() +
                       std::chrono::duration_cast<std::chrono::steady_clock::duration>(
                           std::chrono::duration<double>(arguments.max_duration));
  }
  return options;
}

void print(const SweepArguments& arguments, const SweptFile& file) {
  if (!arguments.all && !file.is_news()) return;
  if (arguments.json) {
    std::cout << file.line << "\n";
    return;
  }
  const nlohmann::ordered_json json = parse_json_line(file.line);
  std::cout << printable(file.target) << ": " << name_of(file.state);
  if (file.change() == "restored") {
    std::cout << " again, was " << name_of(file.before);
  } else if (file.is_new) {
    std::cout << ", was " << name_of(file.before);
  } else if (file.state != FileState::Intact) {
    std::cout << (file.is_accepted ? ", as accepted" : ", as at the last sweep");
  }
  if (const auto damage = json.find("damage"); damage != json.end()) {
    std::cout << ", " << (*damage)["units_damaged"] << " of " << (*damage)["units_expected"]
              << " units damaged, at " << (*damage)["vertices"].size() << " vertices";
  } else if (json.contains("units_found") && json["units_recorded"] != 0) {
    std::cout << ", " << json["units_found"] << " of " << json["units_recorded"] << " units";
  }
  const std::string detail = json.value("detail", "");
  if (!detail.empty()) std::cout << " (" << printable(detail) << ")";
  std::cout << "\n";
}

// Counts what a sweep finds, and says how it ended. Counters of the tally outlive a worker.
class SweepReport {
 public:
  SweepReport(const SweepArguments& arguments, const WorkOrder& order)
      : arguments_(arguments), tally_(arguments.run, order, 0, kinds()) {}

  // The states, and what is no news of its state.
  static std::vector<std::string_view> kinds() {
    std::vector<std::string_view> names = file_state_names();
    names.emplace_back("restored");
    names.emplace_back("accepted");
    return names;
  }

  void add(const SweptFile& file, const LoggedRun& run) {
    tally_.clear_bar();
    print(arguments_, file);
    check_standard_output();
    if (file.is_news()) {
      run.note(file.target, file.is_new ? file.change() : name_of(file.state),
               parse_json_line(file.line));
    }
    tally_.count(kind_of(file), file.is_news() && !is_restored(file), false, file.target);
  }

  [[nodiscard]] int finish(const SweepEnd& end) {
    int code = tally_.finish("file", "files");
    if (end.is_out_of_time && !arguments_.run.is_quiet()) {
      std::cerr << "triglyph: out of time; the same command goes on from here\n";
    }
    if (code != kDone && code != kSomeFailed) return code;
    const bool has_failed = tally_.counted(static_cast<std::size_t>(FileState::Unreadable)) > 0;
    const bool has_changed = tally_.failed() > 0 || tally_.counted(restored()) > 0;
    if (has_failed || tally_.gave_up()) return kSomeFailed;
    return has_changed ? kNoMark : kDone;
  }

 private:
  static std::size_t restored() { return file_state_names().size(); }

  static bool is_restored(const SweptFile& file) {
    return file.is_new && file.state == FileState::Intact;
  }
  static std::size_t kind_of(const SweptFile& file) {
    if (is_restored(file)) return restored();
    const bool is_passed_over = file.is_accepted && file.state != FileState::Intact;
    return is_passed_over ? restored() + 1 : static_cast<std::size_t>(file.state);
  }

  const SweepArguments& arguments_;
  RunTally tally_;
};

int run_sweep(const SweepArguments& arguments) {
  const std::vector<Key> keys = arguments.keys.load();
  const SweepOptions options = options_of(arguments);
  const fs::path& path = arguments.run.ledger();
  if (path.empty()) throw Error(ErrorCode::Usage, {}, "", "name the --ledger of the library");
  if (!is_ledger_file(path)) throw Error(ErrorCode::Unreadable, path, "", "is no ledger");
  return arguments.run.supervised({"sweep", SweepReport::kinds()}, [&](const WorkOrder& order) {
    Ledger ledger(path);
    std::error_code ignored;
    const std::optional<std::int64_t> unfinished =
        arguments.restart ? std::nullopt
                          : unfinished_sweep(ledger, command_line(), fs::current_path(ignored));
    const LoggedRun run(&ledger, order, "sweep", unfinished);
    SweepReport report(arguments, order);
    const SweepEnd end = sweep(
        ledger, run.id(), keys, options, arguments.run.context(order),
        [&](const SweptFile& file) { report.add(file, run); }, order.board->stop());
    if (order.only) return kDone;
    const int code = report.finish(end);
    if (!arguments.junit.empty()) write_junit_report(ledger, run.id(), arguments.junit);
    if (end.is_out_of_time) {
      ledger.end_run(run.id(), kOutOfTime);
    } else if (code == kNoMark) {
      ledger.end_run(run.id(), "changed");
    } else {
      run.end(code);
    }
    return code;
  });
}

}  // namespace

void add_sweep_verb(CLI::App& app, Action& action) {
  CLI::App* verb = app.add_subcommand(
      "sweep", "Look through the outputs that a ledger knows, and say what changed");
  auto arguments = std::make_shared<SweepArguments>();
  verb->add_option("inputs", arguments->inputs,
                   "Files and folders to look at, also such as are gone (default: all outputs)")
      ->type_name("FILE|FOLDER");
  const std::map<std::string, double> units{
      {"s", 1}, {"m", 60}, {"h", 3600}, {"d", 86400}, {"w", 604800}};
  const auto duration = CLI::AsNumberWithUnit(units, CLI::AsNumberWithUnit::DEFAULT, "DURATION");
  verb->add_option("--subset", arguments->subset,
                   "Look at part I of N alone; each file stays in its part")
      ->type_name("I/N");
  verb->add_option("--sample", arguments->sample,
                   "Look at this share of the files, at others in each sweep")
      ->type_name("P%");
  verb->add_option("--max-duration", arguments->max_duration,
                   "Start no file after this time, such as 90s, 30m or 2h; the same command then "
                   "goes on from there")
      ->transform(duration)
      ->type_name("DURATION");
  verb->add_option("--younger-than", arguments->younger_than,
                   "Look only at what was marked within this time, such as 12h, 30d or 4w")
      ->transform(duration)
      ->type_name("DURATION");
  verb->add_option("--search", arguments->search,
                   "Look for missing files in this folder too; may be given several times")
      ->type_name("DIR");
  verb->add_flag("--full", arguments->full,
                 "Read every mark, also where the bytes are known from an earlier sweep");
  verb->add_flag("--accept", arguments->accept,
                 "Take what is found as known: it is no news until it changes again");
  verb->add_flag("--restart", arguments->restart,
                 "Begin anew, also if the same sweep did not come to its end");
  verb->add_flag("--all", arguments->all, "Print every file, not only what changed or is wrong");
  verb->add_flag("--json", arguments->json, "Print one JSON object per file");
  verb->add_option("--junit", arguments->junit, "Write JUnit XML with a test for every file")
      ->type_name("FILE");
  arguments->keys.add_to(*verb);
  arguments->run.add_to(*verb);
  verb->footer(
      "Say what changed in a library since the last sweep; exit code 0: nothing, 4: something, 3: "
      "some files could not be looked at:\n"
      "  triglyph sweep --ledger marked.ledger --key-file owner.key --junit sweep.xml\n"
      "Look at a seventh of it each night, for two hours at most:\n"
      "  triglyph sweep --ledger marked.ledger --key-file owner.key --subset 3/7 "
      "--max-duration 2h");
  verb->callback([&action, arguments] { action = [arguments] { return run_sweep(*arguments); }; });
}

}  // namespace triglyph
