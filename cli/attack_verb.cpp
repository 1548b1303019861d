#include <algorithm>
#include <iostream>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "cli/app.h"
#include "cli/attack_arguments.h"
#include "cli/run_arguments.h"
#include "cli/verbs.h"
#include "engine/attack/collusion.h"
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
  std::optional<std::string> collusion;
  fs::path out;  // of a collusion
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
  return {{words[1], words[2], Attack::parsed(words[0]), {}, {}}};
}

// All meshes combined into one, which the attacks then change one after the other.
std::vector<AttackJob> collusion_job(const MeshAttackArguments& arguments) {
  const CollusionKind& kind = collusion_named(*arguments.collusion);
  if (!arguments.out_dir.empty()) refuse("--collude writes one mesh: give --out, not --out-dir");
  if (arguments.out.empty()) refuse("--collude needs the file to write: give --out");
  const std::vector<std::string>& copies = arguments.inputs;
  if (copies.size() < 2) {
    refuse("--collude needs two copies or more, not " + std::to_string(copies.size()));
  }
  for (const std::string& copy : copies) check_name(copy);
  check_name(arguments.out.string());
  return {{copies.front(),
           arguments.out,
           arguments.attacks.in_a_row(),
           {copies.begin() + 1, copies.end()},
           kind.collusion}};
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
      jobs.push_back({file.path, std::move(out), attack, {}, {}});
    }
  }
  return jobs;
}

std::vector<AttackJob> jobs_of(const MeshAttackArguments& arguments) {
  if (arguments.collusion) return collusion_job(arguments);
  if (!arguments.out.empty()) refuse("--out is of --collude; else give ATTACK MESH OUT");
  return arguments.out_dir.empty() ? single_job(arguments) : all_jobs(arguments);
}

std::string_view name_of_collusion(Collusion collusion) {
  for (const CollusionKind& kind : collusion_kinds()) {
    if (kind.collusion == collusion) return kind.name;
  }
  return "";
}

std::vector<std::string> names_of_collusions() {
  std::vector<std::string> names;
  for (const CollusionKind& kind : collusion_kinds()) names.emplace_back(kind.name);
  return names;
}

// What was done, as a line of text says it: "simplify:50", "average of 3 copies, noise:0.1".
std::string deed(const AttackJob& job) {
  if (!job.collusion) return job.attack.text();
  std::string text = std::string(name_of_collusion(*job.collusion)) + " of " +
                     std::to_string(job.more_copies.size() + 1) + " copies";
  if (job.attack.text() != "none") text += ", " + job.attack.text();
  return text;
}

// The inputs of a job: "mesh", or of a collusion "copies", a list.
void put_inputs(nlohmann::ordered_json& line, const AttackJob& job) {
  if (!job.collusion) return put_path(line, "mesh", job.mesh);
  line["collusion"] = name_of_collusion(*job.collusion);
  line["copies"] = nlohmann::ordered_json::array({job.mesh.string()});
  for (const fs::path& copy : job.more_copies) line["copies"].push_back(copy.string());
}

void print_result(const AttackResult& result, std::uint64_t seed, bool json) {
  const AttackJob& job = result.job;
  if (result.failure) std::cerr << "triglyph: " << printable(result.failure->error) << "\n";
  if (!json) {
    if (!result.attacked) return;
    std::cout << printable(job.out.string()) << ": " << deed(job) << ", " << result.attacked->points
              << " points, " << result.attacked->triangles << " triangles\n";
    return;
  }
  nlohmann::ordered_json line;
  put_inputs(line, job);
  put_path(line, "out", job.out);
  line["attack"] = job.attack.text();
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
  const std::vector<AttackJob> jobs = jobs_of(arguments);
  const std::uint64_t seed = arguments.attacks.seed();
  return arguments.run.supervised({"attack", {"attacked", "failed"}}, [&](const WorkOrder& order) {
    std::optional<Ledger> ledger;
    if (!arguments.run.ledger().empty()) ledger.emplace(arguments.run.ledger());
    const LoggedRun run(ledger ? &*ledger : nullptr, order, "attack");
    std::vector<fs::path> files;
    for (const AttackJob& job : jobs) files.push_back(job.mesh);
    RunTally tally(arguments.run, order, files, {"attacked", "failed"});
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
  verb->add_option(
          "inputs", arguments->inputs,
          "An attack, a mesh and the file to write; or, with --out-dir, meshes, folders, "
          "globs, manifests (.jsonl), or - for a list on standard input; or, with --collude, "
          "copies of one mesh")
      ->required()
      ->type_name("ATTACK MESH OUT|INPUT");
  arguments->attacks.add_to(*verb);
  verb->add_option("--out-dir", arguments->out_dir,
                   "Directory for the meshes, each attack in a folder of its own")
      ->type_name("DIR");
  verb->add_option("--collude", arguments->collusion,
                   "Combine copies of one mesh, each marked for another recipient, into the mesh "
                   "--out; attacks by --attack follow, in the order given")
      ->type_name(CLI::detail::join(names_of_collusions(), "|"));
  verb->add_option("--out", arguments->out, "Mesh that the copies of --collude are combined into")
      ->type_name("MESH");
  verb->add_flag("--json", arguments->json, "Print one JSON object per mesh and attack");
  arguments->run.add_to(*verb);
  verb->footer("Attacks:\n" + list_of_attacks() + "Collusions:\n" + list_of_collusions() +
               "Simplify a mesh to half of its triangles, then add noise:\n"
               "  triglyph attack simplify:50+noise:0.1 marked/bunny.obj bunny.obj\n"
               "Try what leaked copies may have gone through:\n"
               "  triglyph attack --protocol leaks marked/ --out-dir attacked\n"
               "  triglyph extract attacked/ --key-file owner.key\n"
               "Make one mesh of the copies of three recipients:\n"
               "  triglyph attack --collude average ada.obj ben.obj cem.obj --out leaked.obj");
  verb->callback([&action, arguments] { action = [arguments] { return run_attack(*arguments); }; });
}

}  // namespace triglyph
