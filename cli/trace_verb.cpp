#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/app.h"
#include "cli/options.h"
#include "cli/run_arguments.h"
#include "cli/sibling.h"
#include "cli/trace_report.h"
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
  fs::path reports;  // directory
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
  return arguments.run.supervised({"trace", kinds_of_traces()}, [&](const WorkOrder& order) {
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
    RunTally tally(arguments.run, order, files, kinds_of_traces());
    const TraceOptions trace{arguments.false_alarm, std::max<std::size_t>(arguments.most, 1),
                             static_cast<double>(files.size())};
    const TraceReport report({.names = names,
                              .most = arguments.most,
                              .keys = keys,
                              .ledger = ledger ? &*ledger : nullptr,
                              .options = trace});
    std::optional<RenderBatch> pictures;
    if (!arguments.reports.empty()) pictures.emplace(std::vector<std::string>{"--batch"});
    trace_files(
        files, known.suspects, trace, known.encodings, arguments.run.context(order),
        [&](const TraceResult& result) {
          tally.clear_bar();
          report.print(result, arguments.json);
          check_standard_output();  // nobody is there to read the rest
          if (pictures && report.names_one(result)) {
            const fs::path file = arguments.reports / (folder_of(result.path.string()) + ".md");
            report.write(result, file);
            fs::path picture = file;
            picture.replace_extension(".png");
            if (const auto original = report.original_of(result)) {
              pictures->draw(*original, result.path, picture);
            }
          }
          run.note(result.path, report.status_of(result), report.json_of(result));
          const std::size_t kind =
              result.failure ? kTraceFailedFirst + static_cast<std::size_t>(result.failure->status)
              : report.names_one(result) ? kTraced
                                         : kNobody;
          tally.count(kind, result.failure.has_value(), false, result.path);
        },
        order.board->stop());
    if (order.only) return kDone;
    if (pictures && pictures->finish() != std::size_t{0}) {
      std::cerr << "triglyph: not all pictures were drawn\n";
    }
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
  verb->add_option("--report", arguments->reports,
                   "Write what an expert would ask for of each file whose copy it is, in this "
                   "directory: hashes, formula, counts, and a picture of where it differs from the "
                   "original that the ledger names")
      ->type_name("DIR");
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
