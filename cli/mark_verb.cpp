#include <cerrno>
#include <cstring>
#include <fstream>
#include <iostream>
#include <memory>

#include <sys/resource.h>

#include "cli/app.h"
#include "cli/options.h"
#include "cli/screen.h"
#include "cli/sibling.h"
#include "cli/verbs.h"
#include "engine/base/error.h"
#include "engine/base/parallel.h"
#include "manifests/run.h"

namespace triglyph {
namespace {

constexpr const char* kDefaultMessage = "triglyph";  // 8 bytes, if the user names none

struct MarkArguments {
  std::vector<std::filesystem::path> inputs;
  std::filesystem::path out;
  std::optional<std::string> message;
  std::optional<std::string> message_hex;
  bool fill = false;
  std::optional<std::string> layout;
  LayoutOptions layout_search;
  std::string conflicts{name_of(MarkOptions{}.conflict_rule)};
  std::string assign = "bottleneck";
  std::string cost = "displacement";
  std::uint32_t redundancy = MarkOptions{}.redundancy;
  std::optional<double> max_move_percent;
  double drop_dearest_percent = 0;
  std::filesystem::path records;
  std::filesystem::path pictures;  // directory
  bool json = false;
  bool detail = false;
  SchemeArguments scheme;
  KeyArgument key;
  MachineArguments machine;

  [[nodiscard]] JobSettings settings() const {
    JobSettings settings;
    settings.fill = fill;
    const std::string text = message.value_or(kDefaultMessage);
    settings.message = message_hex ? from_hex(*message_hex) : Message(text.begin(), text.end());
    scheme.apply_to(settings);
    if (layout) settings.layout = layout_method(*layout);
    settings.layout_search = layout_search;
    settings.conflict_rule = conflict_rule(conflicts);
    settings.assign = assign_method(assign);
    settings.cost = cost_function(cost);
    settings.redundancy = redundancy;
    settings.detail = detail;
    settings.drop_dearest = drop_dearest_percent / 100;
    if (max_move_percent) settings.max_move_rel_diag = *max_move_percent / 100;
    // fails early on a message that cannot be, before any mesh is opened
    if (!fill) (void)WordCode(Key::trial(), settings.resolved().format).words_of(settings.message);
    return settings;
  }
};

bool is_manifest(const std::filesystem::path& path) {
  return path.extension() == ".jsonl" || path.extension() == ".json";
}

std::unique_ptr<JobSource> open_jobs(const MarkArguments& arguments) {
  const JobSettings settings = arguments.settings();
  if (arguments.inputs.size() == 1 && is_manifest(arguments.inputs[0])) {
    return std::make_unique<ManifestReader>(arguments.inputs[0], settings, arguments.out);
  }
  if (arguments.out.empty()) {
    throw Error(ErrorCode::Usage, {}, "", "--out is needed to mark meshes without a manifest");
  }
  return std::make_unique<MeshList>(arguments.inputs, settings, arguments.out);
}

std::uint64_t peak_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

std::ofstream open_records(const MarkArguments& arguments) {
  for (const std::filesystem::path& input : arguments.inputs) {
    std::error_code error;
    if (std::filesystem::equivalent(input, arguments.records, error)) {
      throw Error(ErrorCode::Usage, arguments.records, "", "the records would overwrite an input");
    }
  }
  std::ofstream file(arguments.records, std::ios::binary | std::ios::trunc);
  if (!file) throw Error(ErrorCode::Unwritable, arguments.records, "", std::strerror(errno));
  return file;
}

// Where records go as they come: the table or JSON on stdout, JSON in the records file.
class RecordPrinter {
 public:
  RecordPrinter(const MarkArguments& arguments, std::size_t total)
      : json_(arguments.json), bar_(total), records_(arguments.records) {
    if (!arguments.records.empty()) file_ = open_records(arguments);
    if (!json_) print_table_heading(std::cout);
  }

  void print(const Record& record) {
    const bool failed = record.status != Status::Marked;
    failed_ += failed ? 1 : 0;
    bar_.clear();
    if (json_ || file_.is_open()) {
      const std::string line = to_line(to_json(record, peak_bytes()));
      if (json_) std::cout << line << std::flush;
      if (file_.is_open() && !(file_ << line << std::flush)) {
        throw Error(ErrorCode::Unwritable, records_, "", "the record cannot be written");
      }
    }
    if (!json_) print_table_row(std::cout, record);
    if (!record.error.empty()) std::cerr << "triglyph: " << record.error << "\n";
    bar_.advance(failed);
  }

  // The number of meshes that are not marked.
  std::size_t finish() {
    bar_.clear();
    return failed_;
  }

 private:
  bool json_;
  std::size_t failed_ = 0;
  ProgressBar bar_;
  std::filesystem::path records_;
  std::ofstream file_;  // a line at a time, so that a run that dies leaves the records it made
};

// Below the directory for pictures as the marked file is below that for meshes.
std::filesystem::path picture_of(const Record& record, const MarkArguments& arguments) {
  std::filesystem::path name = record.job.out.lexically_relative(arguments.out);
  if (name.empty() || *name.begin() == "..") name = record.job.out.filename();
  return arguments.pictures / (name.string() + ".png");
}

std::vector<std::string> renderer_arguments(const MarkArguments& arguments) {
  std::vector<std::string> words = {"--batch"};
  const int threads = arguments.machine.threads();
  if (threads > 0) words.insert(words.end(), {"--threads", std::to_string(threads)});
  return words;
}

int run_mark(const MarkArguments& arguments) {
  const Key key = arguments.key.load();
  const std::size_t total = check_plan(*open_jobs(arguments));
  const auto jobs = open_jobs(arguments);
  std::optional<RenderBatch> pictures;
  if (!arguments.pictures.empty()) pictures.emplace(renderer_arguments(arguments));
  RecordPrinter printer(arguments, total);
  const std::atomic<bool>& stop = interrupt_flag();
  RunOptions options;
  options.memory_bytes = arguments.machine.memory_bytes();
  with_threads(arguments.machine.threads(), [&] {
    run_jobs(
        *jobs, key, options,
        [&](const Record& record) {
          printer.print(record);
          if (pictures && record.status == Status::Marked) {
            pictures->draw(record.job.mesh, record.job.out, picture_of(record, arguments));
          }
        },
        stop);
  });
  std::size_t failed = printer.finish();
  if (pictures && stop) pictures->stop();
  if (pictures && !pictures->finish()) {
    std::cerr << "triglyph: not all pictures were drawn\n";
    ++failed;
  }
  if (stop) return kInterrupted;
  return failed == 0 ? kDone : kSomeFailed;
}

void add_layout_options(CLI::App& verb, MarkArguments& arguments) {
  verb.add_option("--layout", arguments.layout, "first-fit is un-optimised [the scheme's]")
      ->check(CLI::IsMember(strings(layout_names())));
  verb.add_option("--layout-iterations", arguments.layout_search.iterations,
                  "Passes over the candidates of a layout that searches")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  verb.add_option("--layout-seconds", arguments.layout_search.seconds,
                  "Search for so long instead; the result then depends on the machine")
      ->check(CLI::NonNegativeNumber);
  verb.add_option("--layout-seed", arguments.layout_search.seed, "Random numbers of the search")
      ->capture_default_str();
}

}  // namespace

void add_mark_verb(CLI::App& app, Action& action) {
  CLI::App* verb = app.add_subcommand("mark", "Hide a message in meshes");
  auto arguments = std::make_shared<MarkArguments>();
  verb->add_option("inputs", arguments->inputs, "A manifest (.jsonl), or meshes")
      ->required()
      ->type_name("MANIFEST|MESH...");
  verb->add_option("--out", arguments->out, "Directory for the marked files")->type_name("DIR");
  auto* message =
      verb->add_option("--message", arguments->message, "Message, 1 to 256 bytes [triglyph]");
  auto* hex = verb->add_option("--message-hex", arguments->message_hex, "Message in hexadecimal");
  auto* fill = verb->add_flag("--fill", arguments->fill,
                              "A random message as long as the capacity, the paper's experiment");
  message->excludes(hex)->excludes(fill);
  hex->excludes(fill);
  add_layout_options(*verb, *arguments);
  verb->add_option("--conflicts", arguments->conflicts,
                   "Units interfere if one moves what the other reads, or if they share a point")
      ->check(CLI::IsMember({"read-write", "shared-point"}))
      ->capture_default_str();
  verb->add_option("--assign", arguments->assign, "sequential is un-optimised")
      ->check(CLI::IsMember({"sequential", "bottleneck", "sum"}))
      ->capture_default_str();
  verb->add_option("--cost", arguments->cost, "Local change that the assignment minimises")
      ->check(CLI::IsMember(strings(cost_names())))
      ->capture_default_str();
  verb->add_option("--redundancy", arguments->redundancy,
                   "Units wanted for each part; 0: as many as there are")
      ->capture_default_str();
  verb->add_option("--max-move", arguments->max_move_percent,
                   "Farthest move of a point in percent of the diagonal that a repeat is worth; 0: "
                   "any [the scheme's]")
      ->check(CLI::Range(0.0, 100.0));
  verb->add_option("--drop-dearest", arguments->drop_dearest_percent,
                   "Percent of the candidates to leave out, those dear under every word: less "
                   "capacity, less to be seen")
      ->check(CLI::Range(0.0, 99.9))
      ->capture_default_str();
  verb->add_option("--records", arguments->records, "Write one JSON record a mesh to this file")
      ->type_name("FILE");
  verb->add_option("--render", arguments->pictures,
                   "Draw a comparison of every mesh that is marked into this directory")
      ->type_name("DIR");
  verb->add_flag("--json", arguments->json, "Print the records instead of a table");
  verb->add_flag("--detail", arguments->detail,
                 "Write every unit into the record, for verify --detail [always with iie]");
  arguments->scheme.add_to(*verb);
  arguments->key.add_to(*verb);
  arguments->machine.add_threads_to(*verb);
  arguments->machine.add_memory_to(*verb);
  verb->callback([&action, arguments] { action = [arguments] { return run_mark(*arguments); }; });
}

}  // namespace triglyph
