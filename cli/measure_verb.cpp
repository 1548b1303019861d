#include <algorithm>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "cli/app.h"
#include "cli/options.h"
#include "cli/verbs.h"
#include "engine/base/parallel.h"
#include "engine/geometry/box.h"
#include "engine/io/mesh_file.h"
#include "engine/metric/comparison.h"
#include "manifests/json_line.h"

namespace triglyph {
namespace {

struct MeasureArguments {
  std::filesystem::path original;
  std::filesystem::path marked;
  std::vector<std::string> metrics;
  double tolerance = kHausdorffTolerance;
  bool json = false;
  MachineArguments machine;

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

int run_measure(const MeasureArguments& arguments) {
  nlohmann::ordered_json json;
  with_threads(arguments.machine.threads(), [&] {
    const MeshFile original = MeshFile::open(arguments.original);
    const MeshFile marked = MeshFile::open(arguments.marked);
    const Mesh& first = original.mesh();
    const Mesh& second = marked.mesh();
    const bool same = have_same_triangles(first, second);
    json = {{"original", arguments.original.string()},
            {"marked", arguments.marked.string()},
            {"same_triangles", same},
            {"diagonal", box_diagonal(first.positions)}};
    for (const std::string& metric : chosen_metrics(arguments, same)) {
      for (const auto& [name, value] : compare(first, second, metric, arguments.tolerance)) {
        json[name] = value;
      }
    }
  });
  if (arguments.json) {
    std::cout << to_line(json);
  } else {
    for (const auto& [name, value] : json.items()) std::cout << name << " " << value << "\n";
  }
  return kDone;
}

}  // namespace

void add_measure_verb(CLI::App& app, Action& action) {
  CLI::App* verb =
      app.add_subcommand("measure", "Measure distances between two meshes, in model units");
  auto arguments = std::make_shared<MeasureArguments>();
  verb->add_option("original", arguments->original, "Original mesh")->required()->type_name("MESH");
  verb->add_option("marked", arguments->marked, "Mesh to compare with the original")
      ->required()
      ->type_name("MESH");
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
  arguments->machine.add_threads_to(*verb);
  verb->footer(
      "Compare a marked mesh with its original by every metric:\n"
      "  triglyph measure a.obj marked/a.obj --metric all");
  verb->callback(
      [&action, arguments] { action = [arguments] { return run_measure(*arguments); }; });
}

}  // namespace triglyph
