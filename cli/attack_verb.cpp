#include <algorithm>
#include <iostream>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "cli/app.h"
#include "cli/attack_arguments.h"
#include "cli/run_arguments.h"
#include "cli/verbs.h"
#include "engine/base/error.h"
#include "engine/base/text.h"
#include "manifests/file_runs.h"
#include "manifests/inputs.h"
#include "manifests/json_line.h"

namespace triglyph {
namespace {

namespace fs = std::filesystem;

struct MeshAttackArguments {
  std::vector<std::string> inputs;
  fs::path out_dir;
  AttackArguments attacks;
  bool json = false;
  RunArguments run;
};

[[noreturn]] void refuse(const std::string& reason) {
  throw Error(ErrorCode::Usage, {}, "", reason);
}

// The folder of an attack: its text without the colon, which some file systems refuse.
std::string folder_name(const Attack& attack) {
  std::string name = attack.text();
  std::replace(name.begin(), name.end(), ':', '-');
  return name;
}

std::vector<AttackJob> single_job(const MeshAttackArguments& arguments) {
  const std::vector<std::string>& words = arguments.inputs;
  if (words.size() != 3 || arguments.attacks.names_any()) {
    refuse("give ATTACK MESH OUT, or attacks by --attack or --protocol, meshes and --out-dir");
  }
  check_name(words[2]);
  return {{words[1], words[2], Attack::parsed(words[0])}};
}

// Every mesh under every attack, each attack in a folder of its own.
std::vector<AttackJob> all_jobs(const MeshAttackArguments& arguments) {
  const std::vector<Attack> attacks = arguments.attacks.attacks();
  if (attacks.empty()) refuse("--out-dir needs attacks: give --attack or --protocol");
  std::vector<AttackJob> jobs;
  std::set<fs::path> outputs;
  for (const NamedFile& file : gather_named_files(arguments.inputs, std::cin, arguments.out_dir)) {
    fs::path place = file.path.lexically_relative(file.root);
    if (place.empty() || *place.begin() == "..") place = file.path.filename();
    for (const Attack& attack : attacks) {
      fs::path out = arguments.out_dir / folder_name(attack) / place;
      if (!outputs.insert(out).second) refuse("two meshes would be written to " + out.string());
      jobs.push_back({file.path, std::move(out), attack});
    }
  }
  return jobs;
}

void print_result(const AttackResult& result, std::uint64_t seed, bool json) {
  const auto& [mesh, out, attack] = result.job;
  if (result.failure) std::cerr << "triglyph: " << printable(result.failure->error) << "\n";
  if (!json) {
    if (!result.attacked) return;
    std::cout << printable(out.string()) << ": " << attack.text() << ", " << result.attacked->points
              << " points, " << result.attacked->triangles << " triangles\n";
    return;
  }
  nlohmann::ordered_json line;
  put_path(line, "mesh", mesh);
  put_path(line, "out", out);
  line["attack"] = attack.text();
  line["seed"] = seed;
  if (result.attacked) {
    line["status"] = "attacked";
    line["points"] = result.attacked->points;
    line["triangles"] = result.attacked->triangles;
  } else {
    line["status"] = name_of(result.failure->status);
    line["error"] = result.failure->error;
  }
  std::cout << to_line(line);
}

int run_attack(const MeshAttackArguments& arguments) {
  const std::vector<AttackJob> jobs =
      arguments.out_dir.empty() ? single_job(arguments) : all_jobs(arguments);
  const std::uint64_t seed = arguments.attacks.seed();
  return arguments.run.supervised([&](const WorkOrder& order) {
    std::optional<Ledger> ledger;
    if (!arguments.run.ledger().empty()) ledger.emplace(arguments.run.ledger());
    const LoggedRun run(ledger ? &*ledger : nullptr, order, "attack");
    RunTally tally(arguments.run, order, jobs.size(), {"attacked", "failed"});
    attack_files(
        jobs, seed, arguments.run.context(order),
        [&](const AttackResult& result) {
          tally.clear_bar();
          if (!arguments.run.is_quiet() || arguments.json || result.failure) {
            print_result(result, seed, arguments.json);
          }
          check_standard_output();  // nobody is there to read the rest
          const bool failed = result.failure.has_value();
          tally.count(failed ? 1 : 0, failed, false, result.job.mesh);
        },
        order.board->stop());
    if (order.only) return kDone;
    const bool is_run = !arguments.out_dir.empty();
    const int code = tally.end(is_run, "mesh", "meshes");
    run.end(code);
    return code;
  });
}

}  // namespace

void add_attack_verb(CLI::App& app, Action& action) {
  CLI::App* verb =
      app.add_subcommand("attack", "Do to meshes what happens to copies, on purpose or not");
  auto arguments = std::make_shared<MeshAttackArguments>();
  verb->add_option("inputs", arguments->inputs,
                   "An attack, a mesh and the file to write; or, with --out-dir, meshes, folders, "
                   "globs, manifests (.jsonl), or - for a list on standard input")
      ->required()
      ->type_name("ATTACK MESH OUT|INPUT");
  arguments->attacks.add_to(*verb);
  verb->add_option("--out-dir", arguments->out_dir,
                   "Directory for the meshes, each attack in a folder of its own")
      ->type_name("DIR");
  verb->add_flag("--json", arguments->json, "Print one JSON object per mesh and attack");
  arguments->run.add_to(*verb);
  verb->footer("Attacks:\n" + list_of_attacks() +
               "Simplify a mesh to half of its triangles, then add noise:\n"
               "  triglyph attack simplify:50+noise:0.1 marked/bunny.obj bunny.obj\n"
               "Try what leaked copies may have gone through:\n"
               "  triglyph attack --protocol leaks marked/ --out-dir attacked\n"
               "  triglyph extract attacked/ --key-file owner.key");
  verb->callback([&action, arguments] { action = [arguments] { return run_attack(*arguments); }; });
}

}  // namespace triglyph
