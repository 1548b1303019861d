#include <algorithm>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "cli/app.h"
#include "cli/attack_arguments.h"
#include "cli/options.h"
#include "cli/run_arguments.h"
#include "cli/survival_report.h"
#include "cli/verbs.h"
#include "engine/base/error.h"
#include "engine/base/output_file.h"
#include "engine/base/parallel.h"
#include "engine/base/text.h"
#include "engine/io/mesh_file.h"
#include "engine/scheme/registry.h"
#include "engine/survival/survival.h"
#include "manifests/inputs.h"

namespace triglyph {
namespace {

struct SurviveArguments {
  std::vector<std::string> inputs;
  std::vector<std::string> schemes;
  std::vector<std::string> settings;  // "key=value"
  AttackArguments attacks;
  SurvivalOptions options;
  std::filesystem::path json;
  std::filesystem::path csv;
  MachineArguments machine;
};

void add_setting(const std::string& setting, OptionValues& values) {
  const std::size_t equals = setting.find('=');
  std::string key = setting.substr(0, equals);
  std::replace(key.begin(), key.end(), '-', '_');
  const OptionSpec* spec = find_mark_option(key);
  if (spec == nullptr || equals == setting.npos) {
    std::vector<std::string> known;
    for (const OptionSpec& each : mark_option_specs()) known.push_back(each.key);
    const auto closest = spec == nullptr ? closest_word(key, known) : std::nullopt;
    throw Error(ErrorCode::Usage, {}, "",
                "--set takes an option of marking, as in step=0.2, not " + setting +
                    (closest ? "; did you mean " + *closest + "?" : ""));
  }
  values.insert_or_assign(key, spec->parsed(std::string_view(setting).substr(equals + 1)));
}

// Returns what each scheme is to be asked for. Settings that only other schemes have are passed
// over where several schemes are compared.
std::vector<MarkRequest> requests(const SurviveArguments& arguments,
                                  const std::vector<std::string>& schemes) {
  OptionValues values;
  for (const std::string& setting : arguments.settings) add_setting(setting, values);
  values = layered({{"message", std::string("survives")}}, values);
  std::vector<MarkRequest> all;
  for (const std::string& scheme : schemes) {
    values.insert_or_assign("scheme", scheme);
    check_contradictions(values, schemes.size() == 1 ? scheme : std::string());
    all.push_back(resolve(values));
    if (all.back().is_fill()) {
      throw Error(ErrorCode::Usage, {}, "", "fill carries no message that could survive");
    }
  }
  return all;
}

// The files to write in the end, whole or not at all.
class Reports {
 public:
  explicit Reports(const SurviveArguments& arguments) : arguments_(arguments) {
    csv_ = survival_csv_heading();
  }
  void add(const SurvivalBlock& block) {
    json_ += survival_json(block);
    csv_ += survival_csv(block);
  }
  void write() const {
    write(arguments_.json, json_);
    write(arguments_.csv, csv_);
  }

 private:
  static void write(const std::filesystem::path& path, const std::string& text) {
    if (path.empty()) return;
    OutputFile file(path);
    file.write(text);
    file.commit();
  }

  const SurviveArguments& arguments_;
  std::string json_;
  std::string csv_;
};

// What is measured: schemes by name, what they are asked for, and the attacks.
struct Measurement {
  std::vector<std::string> schemes;
  std::vector<MarkRequest> requests;
  std::vector<Attack> attacks;
  SurvivalOptions options;

  [[nodiscard]] SurvivalBlock of(const std::filesystem::path& path) const {
    const Mesh mesh = MeshFile::open(path).mesh();
    SurvivalBlock block{path, mesh.positions.size(), mesh.triangles.size(), schemes, {}};
    for (const MarkRequest& request : requests) {
      block.results.push_back(survive(mesh, request, attacks, options));
    }
    return block;
  }
};

SurvivalBlock together(const std::vector<SurvivalBlock>& blocks) {
  SurvivalBlock all;
  all.schemes = blocks.front().schemes;
  for (const SurvivalBlock& block : blocks) {
    all.points += block.points;
    all.triangles += block.triangles;
  }
  for (std::size_t s = 0; s < all.schemes.size(); ++s) {
    std::vector<SchemeSurvival> parts;
    for (const SurvivalBlock& block : blocks) parts.push_back(block.results[s]);
    all.results.push_back(combined(parts));
  }
  return all;
}

int run_survive(const SurviveArguments& arguments) {
  Measurement measurement;
  measurement.schemes = arguments.schemes.empty() ? strings(scheme_names()) : arguments.schemes;
  measurement.requests = requests(arguments, measurement.schemes);
  measurement.attacks =
      arguments.attacks.names_any() ? arguments.attacks.attacks() : protocol("benchmark");
  measurement.options = arguments.options;
  measurement.options.seed = arguments.attacks.seed();
  const std::vector<std::filesystem::path> files = gather_files(arguments.inputs, std::cin);
  bool failed = false;
  Reports reports(arguments);
  std::vector<SurvivalBlock> blocks;
  with_threads(arguments.machine.threads(), [&] {
    for (const std::filesystem::path& file : files) {
      try {
        blocks.push_back(measurement.of(file));
      } catch (const Error& error) {
        std::cerr << "triglyph: " << printable(error.what()) << "\n";
        failed = true;
        continue;
      }
      if (blocks.size() > 1) std::cout << "\n";
      print_survival(std::cout, blocks.back());
      check_standard_output();  // nobody is there to read the rest
      reports.add(blocks.back());
    }
  });
  if (blocks.size() > 1) {
    std::cout << "\n";
    print_survival(std::cout, together(blocks));
  }
  reports.write();
  return failed ? kSomeFailed : kDone;
}

}  // namespace

void add_survive_verb(CLI::App& app, Action& action) {
  CLI::App* verb = app.add_subcommand(
      "survive", "Measure which marks come back after which attacks, and what marks cost");
  auto arguments = std::make_shared<SurviveArguments>();
  verb->add_option("inputs", arguments->inputs,
                   "Meshes, folders, globs, manifests (.jsonl), or - for a list on standard input")
      ->required()
      ->type_name("INPUT");
  const auto repeated = [&](const char* name, std::vector<std::string>& values, const char* help) {
    return verb->add_option(name, values, help)->take_all()->expected(1)->allow_extra_args(false);
  };
  repeated("--scheme", arguments->schemes,
           "Scheme to measure; may be given several times (default: all)")
      ->type_name("SCHEME");
  repeated("--set", arguments->settings,
           "Option of marking, such as step=0.2; may be given several times")
      ->type_name("KEY=VALUE");
  arguments->attacks.add_to(*verb);
  verb->add_option("--keys", arguments->options.keys,
                   "Marks to make of each mesh, under as many public trial keys, each attacked by "
                   "lots of its own (1 to 1000; default: 4)")
      ->check(CLI::Range(1, 1000).description(""))
      ->type_name("N");
  verb->add_option("--json", arguments->json, "Write one JSON object per mesh and scheme to a file")
      ->type_name("FILE");
  verb->add_option("--csv", arguments->csv,
                   "Write one row per mesh, scheme and attack to a file of comma-separated values")
      ->type_name("FILE");
  arguments->machine.add_threads_to(*verb);
  verb->footer(
      "Columns: messages read of marks attacked; share of wrong or missing bits before error\n"
      "correction, in the median and at worst; bound of the probability of a false alarm.\n"
      "Measure all schemes under the benchmark's attacks:\n"
      "  triglyph survive bunny.obj\n"
      "Measure one scheme with wider cells under two attacks:\n"
      "  triglyph survive meshes/ --scheme tsq --set step=0.2 --attack noise:0.1 --attack remesh");
  verb->callback(
      [&action, arguments] { action = [arguments] { return run_survive(*arguments); }; });
}

}  // namespace triglyph
