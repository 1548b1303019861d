#include <iostream>
#include <memory>

#include "cli/app.h"
#include "cli/options.h"
#include "cli/verbs.h"
#include "engine/mesh/mesh_file.h"
#include "engine/metric/hausdorff.h"
#include "manifests/run.h"

namespace triglyph {
namespace {

struct MeasureArguments {
  std::filesystem::path original;
  std::filesystem::path marked;
  bool json = false;
  MachineArguments machine;
};

int run_measure(const MeasureArguments& arguments) {
  const MeshFile original = MeshFile::open(arguments.original);
  const MeshFile marked = MeshFile::open(arguments.marked);
  const Mesh& first = original.mesh();
  const Mesh& second = marked.mesh();
  const bool same =
      first.triangles == second.triangles && first.positions.size() == second.positions.size();
  const double diagonal = box_diagonal(first.positions);
  HausdorffDistance distance;
  with_threads(arguments.machine.threads(), [&] {
    distance = same ? hausdorff_of_move(first.triangles, first.positions, second.positions,
                                        kHausdorffTolerance * diagonal)
                    : hausdorff(first, second, kHausdorffTolerance * diagonal);
  });
  nlohmann::ordered_json json = {{"original", arguments.original.string()},
                                 {"marked", arguments.marked.string()},
                                 {"same_connectivity", same},
                                 {"diagonal", diagonal},
                                 {"hausdorff_forward", distance.forward.distance},
                                 {"hausdorff_backward", distance.backward.distance},
                                 {"hausdorff", distance.symmetric()},
                                 {"hausdorff_error", distance.error()},
                                 {"hausdorff_rel_diag", distance.symmetric() / diagonal}};
  if (same) {
    const Displacement moved = displacement(first.positions, second.positions);
    json["displacement_max"] = moved.max;
    json["displacement_rms"] = moved.rms;
  }
  if (arguments.json) {
    std::cout << to_line(json);
  } else {
    for (const auto& [name, value] : json.items()) std::cout << name << " " << value << "\n";
  }
  return kDone;
}

}  // namespace

void add_measure_verb(CLI::App& app, Action& action) {
  CLI::App* verb = app.add_subcommand("measure", "Distances between two meshes, in model units");
  auto arguments = std::make_shared<MeasureArguments>();
  verb->add_option("original", arguments->original, "Mesh")->required();
  verb->add_option("marked", arguments->marked, "Mesh to compare with it")->required();
  verb->add_flag("--json", arguments->json, "One JSON object");
  arguments->machine.add_threads_to(*verb);
  verb->callback(
      [&action, arguments] { action = [arguments] { return run_measure(*arguments); }; });
}

}  // namespace triglyph
