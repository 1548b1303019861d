#include <algorithm>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "cli/app.h"
#include "cli/options.h"
#include "cli/run_arguments.h"
#include "cli/screen.h"
#include "cli/verbs.h"
#include "engine/base/text.h"
#include "engine/io/mesh_file.h"
#include "engine/mesh/surface_diagonal.h"
#include "engine/metric/comparison.h"
#include "manifests/file_runs.h"
#include "manifests/json_line.h"
#include "manifests/ledger.h"

namespace triglyph {
namespace {

struct MeasureArguments {
  std::vector<std::string> inputs;
  std::vector<std::string> metrics;
  double tolerance = kHausdorffTolerance;
  bool json = false;
  RunArguments run;

  [[nodiscard]] bool wants_all() const {
    return std::find(metrics.begin(), metrics.end(), "all") != metrics.end();
  }
};

// Returns the metrics to compute; by default and for "all" only those that apply to these meshes.
std::vector<std::string> chosen_metrics(const MeasureArguments& arguments, bool same_triangles) {
  if (!arguments.metrics.empty() && !arguments.wants_all()) return arguments.metrics;
  std::vector<std::string> chosen = {"hausdorff", "displacement"};
  if (arguments.wants_all()) chosen = strings(metric_names());
  std::erase_if(chosen, [&](const std::string& metric) {
    return needs_same_triangles(metric) && !same_triangles;
  });
  return chosen;
}

nlohmann::ordered_json measured(const MeasureArguments& arguments, const MeshPair& pair) {
  const MeshFile original = MeshFile::open(pair.original);
  const MeshFile marked = MeshFile::open(pair.marked);
  const Mesh& first = original.mesh();
  const Mesh& second = marked.mesh();
  const bool same = have_same_triangles(first, second);
  nlohmann::ordered_json json;
  put_path(json, "original", pair.original);
  put_path(json, "marked", pair.marked);
  json["same_triangles"] = same;
  json["diagonal"] = surface_diagonal(first);
  for (const std::string& metric : chosen_metrics(arguments, same)) {
    for (const auto& [name, value] : compare(first, second, metric, arguments.tolerance)) {
      json[name] = value;
    }
  }
  return json;
}

nlohmann::ordered_json json_of(const PairResult& result) {
  if (!result.failure) return result.values;
  nlohmann::ordered_json json;
  put_path(json, "original", result.pair.original);
  put_path(json, "marked", result.pair.marked);
  json["status"] = name_of(result.failure->status);
  json["error"] = result.failure->error;
  return json;
}

void print_measured(const PairResult& result, bool json, bool is_first) {
  if (result.failure) std::cerr << "triglyph: " << printable(result.failure->error) << "\n";
  if (json) {
    std::cout << to_line(json_of(result));
  } else if (!result.failure) {
    if (!is_first) std::cout << "\n";
    for (const auto& [name, value] : result.values.items()) {
      std::cout << name << " "
                << value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) << "\n";
    }
  }
  std::cout.flush();
  check_standard_output();  // nobody is there to read the rest
}

int run_measure(const MeasureArguments& arguments) {
  const bool is_run = name_many_pairs(arguments.inputs);
  (void)pairs_of(arguments.inputs);  // a mistake is to be known before the run
  return arguments.run.supervised({"measure", {"measured", "failed"}}, [&](const WorkOrder& order) {
    std::optional<Ledger> ledger;
    if (!arguments.run.ledger().empty()) ledger.emplace(arguments.run.ledger());
    const LoggedRun run(ledger ? &*ledger : nullptr, order, "measure");
    RunTally tally(arguments.run, order, 0, {"measured", "failed"});
    run_pairs(
        pairs_of(arguments.inputs),
        [&](PairResult& result) { result.values = measured(arguments, result.pair); },
        arguments.run.context(order),
        [&](const PairResult& result) {
          tally.clear_bar();
          print_measured(result, arguments.json, tally.counted(0) == 0);
          const bool failed = result.failure.has_value();
          run.note(result.pair.original, failed ? name_of(result.failure->status) : "measured",
                   json_of(result));
          tally.count(failed ? 1 : 0, failed, false, result.pair.original);
        },
        order.board->stop());
    if (order.only) return kDone;
    const int code = tally.end(is_run, "pair", "pairs");
    run.end(code);
    return code;
  });
}

}  // namespace

void add_measure_verb(CLI::App& app, Action& action) {
  CLI::App* verb =
      app.add_subcommand("measure", "Measure distances between two meshes, in model units");
  auto arguments = std::make_shared<MeasureArguments>();
  verb->add_option("inputs", arguments->inputs,
                   "The original and the mesh to compare with it; two folders, in which meshes at "
                   "the same place belong together; or records or a ledger, for every mesh marked")
      ->required()
      ->expected(1, 2)
      ->type_name("MESH MESH|DIR DIR|RECORDS");
  std::vector<std::string> names = strings(metric_names());
  names.emplace_back("all");
  verb->add_option("--metric", arguments->metrics,
                   "Metrics, separated by commas: " + CLI::detail::join(names, ", ") +
                       " (default: hausdorff,displacement)")
      ->delimiter(',')
      ->check(CLI::IsMember(names).description(""))
      ->type_name("NAME");
  verb->add_option("--tolerance", arguments->tolerance,
                   "Greatest error of the Hausdorff distance, as a share of the bounding box's "
                   "diagonal (1e-12 to 1; default: 1e-6)")
      ->check(CLI::Range(1e-12, 1.0).description(""))
      ->type_name("N");
  verb->add_flag("--json", arguments->json, "Print one JSON object");
  arguments->run.add_to(*verb);
  verb->footer(
      "Compare a marked mesh with its original by every metric:\n"
      "  triglyph measure a.obj marked/a.obj --metric all\n"
      "Compare every mesh of a run with its original:\n"
      "  triglyph measure run.jsonl --json");
  verb->callback(
      [&action, arguments] { action = [arguments] { return run_measure(*arguments); }; });
}

}  // namespace triglyph
