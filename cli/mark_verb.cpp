#include <cerrno>
#include <fstream>
#include <iostream>
#include <memory>

#include "cli/app.h"
#include "cli/options.h"
#include "cli/screen.h"
#include "cli/sibling.h"
#include "cli/verbs.h"
#include "engine/base/error.h"
#include "engine/base/parallel.h"
#include "manifests/json_line.h"
#include "manifests/run.h"

namespace triglyph {
namespace {

constexpr const char* kDefaultMessage = "triglyph";  // 8 bytes, if the user names none

struct MarkArguments {
  std::vector<std::filesystem::path> inputs;
  std::filesystem::path out;
  OptionValues values;
  std::filesystem::path records;
  std::filesystem::path pictures;  // directory
  bool json = false;
  KeyArgument key;
  MachineArguments machine;

  // Returns the values, with the default message if the user gives none.
  [[nodiscard]] OptionValues values_with_message() const {
    return layered({{"message", std::string(kDefaultMessage)}}, values);
  }
};

bool is_manifest(const std::filesystem::path& path) {
  return path.extension() == ".jsonl" || path.extension() == ".json";
}

std::unique_ptr<JobSource> open_jobs(const MarkArguments& arguments) {
  const OptionValues values = arguments.values_with_message();
  if (arguments.inputs.size() == 1 && is_manifest(arguments.inputs[0])) {
    check_contradictions(arguments.values, "");  // its lines may choose the scheme
    (void)resolve(values);
    return std::make_unique<ManifestReader>(arguments.inputs[0], values, arguments.out);
  }
  check_contradictions(arguments.values, scheme_of(values));
  if (arguments.out.empty()) {
    throw Error(ErrorCode::Usage, {}, "", "--out is needed to mark meshes without a manifest");
  }
  return std::make_unique<MeshList>(arguments.inputs, values, arguments.out);
}

std::ofstream open_records(const MarkArguments& arguments) {
  for (const std::filesystem::path& input : arguments.inputs) {
    std::error_code error;
    if (std::filesystem::equivalent(input, arguments.records, error)) {
      throw Error(ErrorCode::Usage, arguments.records, "", "the records would overwrite an input");
    }
  }
  std::ofstream file(arguments.records, std::ios::binary | std::ios::trunc);
  if (!file) throw Error(ErrorCode::Unwritable, arguments.records, "", system_reason(errno));
  return file;
}

// Prints records as they arrive: as a table or JSON on standard output, as JSON in the records
// file.
class RecordPrinter {
 public:
  RecordPrinter(const MarkArguments& arguments, std::size_t total)
      : json_(arguments.json), bar_(total), records_(arguments.records) {
    if (!arguments.records.empty()) file_ = open_records(arguments);
    if (!json_) print_table_heading(std::cout);
  }

  void print(const Record& record) {
    const bool failed = !record.file.is_marked();
    failed_ += failed ? 1 : 0;
    bar_.clear();
    if (json_ || file_.is_open()) {
      const std::string line = to_line(to_json(record));
      if (json_) std::cout << line << std::flush;
      if (file_.is_open() && !(file_ << line << std::flush)) {
        throw Error(ErrorCode::Unwritable, records_, "", "the record cannot be written");
      }
    }
    if (!json_) print_table_row(std::cout, record);
    if (!record.file.error.empty()) std::cerr << "triglyph: " << record.file.error << "\n";
    bar_.advance(failed);
  }

  // Returns the number of meshes that are not marked.
  std::size_t finish() {
    bar_.clear();
    return failed_;
  }

 private:
  bool json_;
  std::size_t failed_ = 0;
  ProgressBar bar_;
  std::filesystem::path records_;
  std::ofstream file_;  // flushed line by line, so that an aborted run keeps its records
};

// Returns the path of the picture: relative to its directory as the marked file is to its own.
std::filesystem::path picture_of(const Record& record, const MarkArguments& arguments) {
  std::filesystem::path name = record.file.out.lexically_relative(arguments.out);
  if (name.empty() || *name.begin() == "..") name = record.file.out.filename();
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
  FlowOptions options;
  options.memory_bytes = arguments.machine.memory_bytes();
  with_threads(arguments.machine.threads(), [&] {
    run_jobs(
        *jobs, key, options,
        [&](const Record& record) {
          printer.print(record);
          if (pictures && record.file.is_marked()) {
            pictures->draw(record.file.mesh, record.file.out, picture_of(record, arguments));
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

}  // namespace

void add_mark_verb(CLI::App& app, Action& action) {
  CLI::App* verb = app.add_subcommand("mark", "Hide a message in meshes");
  auto arguments = std::make_shared<MarkArguments>();
  verb->add_option("inputs", arguments->inputs, "A manifest (.jsonl), or meshes")
      ->required()
      ->type_name("MANIFEST|MESH");
  verb->add_option("--out", arguments->out, "Directory for the marked files")->type_name("DIR");
  add_declared_options(*verb, mark_option_specs(), arguments->values);
  verb->add_option("--records", arguments->records, "Write one JSON record per mesh to this file")
      ->type_name("FILE");
  verb->add_option("--render", arguments->pictures,
                   "Draw a picture that compares each mesh with its marked copy, in this directory")
      ->type_name("DIR");
  verb->add_flag("--json", arguments->json, "Print the records instead of a table");
  arguments->key.add_to(*verb);
  arguments->machine.add_threads_to(*verb);
  arguments->machine.add_memory_to(*verb);
  verb->footer(
      "Hide a message in some meshes, and keep what is needed to verify them:\n"
      "  triglyph mark a.obj b.ply --out marked --message \"for Ada\" --key-file owner.key "
      "--records run.jsonl\n"
      "Mark what a manifest lists, with its own options for each mesh:\n"
      "  triglyph mark collection.jsonl --out marked --key-file owner.key");
  verb->callback([&action, arguments] { action = [arguments] { return run_mark(*arguments); }; });
}

}  // namespace triglyph
