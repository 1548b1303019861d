#include <cmath>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/app.h"
#include "cli/options.h"
#include "cli/run_arguments.h"
#include "cli/verbs.h"
#include "engine/base/error.h"
#include "engine/base/text.h"
#include "manifests/file_runs.h"
#include "manifests/inputs.h"
#include "manifests/json_line.h"
#include "manifests/suspects_of.h"

namespace triglyph {
namespace {

namespace fs = std::filesystem;

struct TraceArguments {
  std::vector<std::string> inputs;
  fs::path recipients;
  std::vector<fs::path> originals;
  double false_alarm = 1e-9;
  std::size_t most = 5;
  bool json = false;
  OptionValues values;
  KeysArgument keys;
  RunArguments run;
};

// The options with which a list of recipients may have been marked: what is not given may have been
// either.
std::vector<MarkOptions> options_of_list(OptionValues values) {
  values["recipient"] = std::string("any");
  std::vector<MarkOptions> options;
  for (const char* strength : {"normal", "strong"}) {
    OptionValues all = values;  // the code against two colluders is that against none
    all.emplace("strength", std::string(strength));
    options.push_back(resolve(all).options);
  }
  return options;
}

std::string text_of(FingerprintLayer layer) {
  switch (layer) {
    case FingerprintLayer::Units:
      return "units";
    case FingerprintLayer::Flux:
      return "flux";
    case FingerprintLayer::Points:
      return "points";
  }
  return "";
}

// Prints what came of tracing, and knows the ledger that tells more of a name.
class TraceReport {
 public:
  TraceReport(const TraceArguments& arguments, std::span<const Key> keys, const Ledger* ledger,
              const TraceOptions& options, std::size_t names)
      : arguments_(arguments), keys_(keys), ledger_(ledger), options_(options), names_(names) {}

  [[nodiscard]] bool names_one(const TraceResult& result) const {
    const bool by_fingerprint =
        result.trace && !result.trace->names.empty() && options_.believes(result.trace->names[0]);
    return by_fingerprint || (result.reading && result.reading->mark);
  }

  [[nodiscard]] std::string_view status_of(const TraceResult& result) const {
    if (result.failure) return name_of(result.failure->status);
    return names_one(result) ? "traced" : "nobody";
  }

  void print(const TraceResult& result) const {
    if (result.failure) std::cerr << "triglyph: " << printable(result.failure->error) << "\n";
    if (arguments_.json) {
      std::cout << to_line(json_of(result));
    } else if (!result.failure) {
      print_text(result);
    }
    check_standard_output();  // nobody is there to read the rest
  }

  [[nodiscard]] nlohmann::ordered_json json_of(const TraceResult& result) const {
    nlohmann::ordered_json json;
    put_path(json, "mesh", result.path);
    json["status"] = status_of(result);
    if (result.failure) {
      json["error"] = result.failure->error;
      return json;
    }
    json["vertices"] = result.trace->vertices;
    json["faces"] = result.trace->faces;
    json["candidates"] = names_;
    json["names"] = nlohmann::ordered_json::array();
    for (const Traced& traced : shown_names(result)) json["names"].push_back(json_of(traced));
    if (result.reading && result.reading->mark) {
      json["message_hex"] = to_hex(result.reading->mark->message);
      json["false_alarm_bound"] = result.reading->false_alarm;
    }
    return json;
  }

 private:
  [[nodiscard]] std::span<const Traced> shown_names(const TraceResult& result) const {
    const std::span<const Traced> all = result.trace->names;
    return all.first(std::min(all.size(), arguments_.most));
  }

  [[nodiscard]] nlohmann::ordered_json json_of(const Traced& traced) const {
    nlohmann::ordered_json json;
    put_path(json, "name", std::string(traced.name.begin(), traced.name.end()));
    json["is_believed"] = options_.believes(traced);
    json["evidence_bits"] = traced.evidence.bits;
    json["false_alarm_log2"] = traced.false_alarm_log2;
    json["key"] = keys_[traced.key].fingerprint();
    for (const LayerEvidence& layer : traced.evidence.layers) {
      json["layers"].push_back(
          {{"layer", text_of(layer.layer)}, {"bits", layer.bits}, {"read_as", layer.what}});
    }
    if (!options_.believes(traced)) return json;
    for_each_mark(traced.name, [&](const LedgerMark& mark) {
      nlohmann::ordered_json issued = {{"mark", mark.number}};
      put_path(issued, "mesh", mark.mesh);
      put_path(issued, "out", mark.out);
      issued["issued"] = mark.issued;
      json["marks"].push_back(std::move(issued));
    });
    return json;
  }

  void print_text(const TraceResult& result) const {
    std::cout << printable(result.path.string()) << ": ";
    if (!names_one(result)) {
      std::cout << "nobody of " << names_ << (names_ == 1 ? " name" : " names");
      if (!result.trace->names.empty()) {
        const Traced& best = result.trace->names[0];
        std::cout << "; the best is " << shown(best.name) << ", false alarm 2^"
                  << std::ceil(best.false_alarm_log2);
      }
      std::cout << "\n";
      return;
    }
    const char* separator = "";
    for (const Traced& traced : shown_names(result)) {
      if (!options_.believes(traced)) break;
      std::cout << separator << shown(traced.name) << "  false alarm 2^"
                << std::ceil(traced.false_alarm_log2) << " (";
      const char* comma = "";
      for (const LayerEvidence& layer : traced.evidence.layers) {
        std::cout << comma << text_of(layer.layer) << " " << std::lround(layer.bits);
        comma = ", ";
      }
      std::cout << " bits)";
      print_marks(traced.name);
      separator = "\n  and ";
    }
    if (result.reading && result.reading->mark) {
      std::cout << "the message " << shown(result.reading->mark->message) << "  "
                << result.reading->mark->encoding.scheme;
      print_marks(result.reading->mark->message);
    }
    std::cout << "\n";
  }

  // Prints the last few copies that were issued for a name.
  void print_marks(const Message& name) const {
    constexpr std::size_t kShown = 3;
    std::vector<LedgerMark> marks;
    std::size_t count = 0;
    for_each_mark(name, [&](const LedgerMark& mark) {
      ++count;
      marks.push_back(mark);
      if (marks.size() > kShown) marks.erase(marks.begin());
    });
    for (const LedgerMark& mark : marks) {
      std::cout << "\n    issued " << mark.issued << " as " << printable(mark.out);
    }
    if (count > marks.size()) std::cout << "\n    and " << count - marks.size() << " more";
  }

  void for_each_mark(const Message& name,
                     const std::function<void(const LedgerMark&)>& visit) const {
    if (ledger_ != nullptr) ledger_->for_each_mark_of(to_hex(name), visit);
  }

  const TraceArguments& arguments_;
  std::span<const Key> keys_;
  const Ledger* ledger_;
  TraceOptions options_;
  std::size_t names_;
};

// The kinds of results in the tally.
enum TraceKind : std::size_t { kTraced, kNobody, kTraceFailedFirst };

std::vector<std::string_view> kinds_of_traces() {
  std::vector<std::string_view> kinds = {"traced", "of nobody"};
  const auto statuses = file_status_names();
  kinds.insert(kinds.end(), statuses.begin(), statuses.end());
  return kinds;
}

int run_trace(const TraceArguments& arguments) {
  const std::vector<Key> keys = arguments.keys.load();
  if (arguments.run.ledger().empty() && arguments.recipients.empty()) {
    throw Error(ErrorCode::Usage, {}, "",
                "nobody to look for: give --ledger, in which marking entered the copies, or "
                "--recipients");
  }
  const fs::path& path = arguments.run.ledger();
  if (!path.empty() && !is_ledger_file(path)) {
    throw Error(ErrorCode::Unreadable, path, "", "is no ledger");
  }
  const auto list = arguments.recipients.empty() ? nullptr : read_recipients(arguments.recipients);
  const std::vector<MarkOptions> options = options_of_list(arguments.values);
  const std::vector<fs::path> files = gather_files(arguments.inputs, std::cin);
  return arguments.run.supervised([&](const WorkOrder& order) {
    std::optional<Ledger> ledger;
    if (!path.empty()) ledger.emplace(path);
    const KnownCopies known =
        known_copies(ledger ? &*ledger : nullptr, list.get(), options, keys, arguments.originals);
    std::size_t names = 0;
    for (const Suspects& suspects : known.suspects) names += suspects.count();
    if (names == 0 && known.encodings.empty()) {
      throw Error(ErrorCode::Usage, path, "", "knows no copy that was marked under these keys");
    }
    const LoggedRun run(ledger ? &*ledger : nullptr, order, "trace");
    RunTally tally(arguments.run, order, files.size(), kinds_of_traces());
    const TraceOptions trace{arguments.false_alarm, std::max<std::size_t>(arguments.most, 1),
                             static_cast<double>(files.size())};
    const TraceReport report(arguments, keys, ledger ? &*ledger : nullptr, trace, names);
    trace_files(
        files, known.suspects, trace, known.encodings, arguments.run.context(order),
        [&](const TraceResult& result) {
          tally.clear_bar();
          report.print(result);
          run.note(result.path, report.status_of(result), report.json_of(result));
          const std::size_t kind =
              result.failure ? kTraceFailedFirst + static_cast<std::size_t>(result.failure->status)
              : report.names_one(result) ? kTraced
                                         : kNobody;
          tally.count(kind, result.failure.has_value(), false, result.path);
        },
        order.board->stop());
    if (order.only) return kDone;
    int code = tally.finish("file", "files");
    if (code == kDone && tally.counted(kNobody) > 0) code = kNoMark;
    run.end(code);
    return code;
  });
}

// The options that a mark of a list must have been made with; a ledger knows those of its marks.
const std::vector<OptionSpec>& trace_option_specs() {
  static const std::vector<OptionSpec> specs = [] {
    std::vector<OptionSpec> some = encoding_option_specs();
    for (const char* key : {"strength", "collusion"}) {
      some.push_back(*find_mark_option(key));
    }
    some[0].default_text = "auto";
    return some;
  }();
  return specs;
}

}  // namespace

void add_trace_verb(CLI::App& app, Action& action) {
  CLI::App* verb = app.add_subcommand("trace", "Say whose copy a mesh is");
  auto arguments = std::make_shared<TraceArguments>();
  verb->add_option("inputs", arguments->inputs,
                   "Meshes, folders, globs, manifests (.jsonl), or - for a list on standard input")
      ->required()
      ->type_name("INPUT");
  verb->add_option("--recipients", arguments->recipients,
                   "Look for the names of this list, also without a ledger")
      ->type_name("FILE");
  verb->add_option(
          "--original", arguments->originals,
          "Compare the suspects with this mesh, of which they may be copies or pieces; may "
          "be given several times. Meshes whose marks cannot be read without theirs are "
          "found by the ledger")
      ->type_name("MESH");
  verb->add_option("--false-alarm", arguments->false_alarm,
                   "Name only whom chance would name with a lower probability, whatever the number "
                   "of names, keys and files")
      ->capture_default_str()
      ->check(CLI::Range(1e-300, 1.0).description(""))
      ->type_name("PROBABILITY");
  verb->add_option("--most", arguments->most, "Names to print of a file at most")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000).description(""))
      ->type_name("COUNT");
  verb->add_flag("--json", arguments->json, "Print one JSON object per mesh");
  add_declared_options(*verb, trace_option_specs(), arguments->values);
  arguments->keys.add_to(*verb);
  arguments->run.add_to(*verb);
  verb->footer(
      "Make a copy for each of several recipients, and say later whose copy turned up:\n"
      "  triglyph mark bunny.obj --out copies --recipients buyers.csv --key-file owner.key\n"
      "  triglyph trace found/ --ledger copies.ledger --key-file owner.key");
  verb->callback([&action, arguments] { action = [arguments] { return run_trace(*arguments); }; });
}

}  // namespace triglyph
