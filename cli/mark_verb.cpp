#include <iostream>
#include <memory>

#include "cli/app.h"
#include "cli/options.h"
#include "cli/progress.h"
#include "cli/run_arguments.h"
#include "cli/screen.h"
#include "cli/sibling.h"
#include "cli/verbs.h"
#include "engine/base/error.h"
#include "engine/base/text.h"
#include "manifests/json_line.h"
#include "manifests/records_file.h"
#include "manifests/run.h"

namespace triglyph {
namespace {

namespace fs = std::filesystem;

struct MarkArguments {
  std::vector<std::string> inputs;
  fs::path out;
  OptionValues values;
  fs::path recipients;
  fs::path records;
  fs::path pictures;  // directory
  std::string shard;  // "3/7"
  bool json = false;
  bool dry_run = false;
  bool companions = false;
  bool no_shapes = false;
  bool keep_times = false;
  ResumeOptions resume;
  KeyArgument key;
  RunArguments run;
};

bool is_manifest(const fs::path& path) {
  return path.extension() == ".jsonl" || path.extension() == ".json";
}

bool has_manifest(const MarkArguments& arguments) {
  return arguments.inputs.size() == 1 && is_manifest(arguments.inputs[0]);
}

Shard shard_of(const MarkArguments& arguments) {
  return arguments.shard.empty() ? Shard() : Shard::parsed(arguments.shard, "--shard");
}

// Opens the same jobs any number of times; the list on standard input is read once.
class Jobs {
 public:
  explicit Jobs(const MarkArguments& arguments) : arguments_(arguments), values_(arguments.values) {
    if (!arguments.recipients.empty()) {
      recipients_ = read_recipients(arguments.recipients);
      // contradicts any other payload
      values_.merge(for_recipient(*recipients_));
    }
    if (has_manifest(arguments)) {
      check_contradictions(values_, "");  // its lines may choose the scheme
      return;
    }
    for (const std::string& input : arguments.inputs) {
      if (!is_manifest(input)) continue;
      throw Error(ErrorCode::Usage, input, "",
                  "a manifest is marked alone, without further meshes or manifests");
    }
    check_contradictions(values_, scheme_of(values_));
    if (arguments.out.empty()) {
      throw Error(ErrorCode::Usage, {}, "", "--out is needed to mark meshes without a manifest");
    }
    meshes_ = gather_named_files(arguments.inputs, std::cin, arguments.out);
  }

  // Returns the jobs of one shard.
  [[nodiscard]] std::unique_ptr<JobSource> open(const Shard& shard, const ShardPlan& plan) const {
    if (shard.is_whole()) return open();
    return std::make_unique<ShardSource>(open(), shard, plan);
  }

  // Returns the plan that all shards share.
  [[nodiscard]] ShardPlan plan_of(const Shard& shard) const {
    return shard.is_whole() ? ShardPlan() : plan_shards(*open());
  }

  // Returns all jobs.
  [[nodiscard]] std::unique_ptr<JobSource> open() const {
    if (has_manifest(arguments_)) {
      return with_copies(
          std::make_unique<ManifestReader>(arguments_.inputs[0], values_, arguments_.out));
    }
    return with_copies(std::make_unique<MeshList>(meshes_, values_, arguments_.out));
  }

 private:
  [[nodiscard]] std::unique_ptr<JobSource> with_copies(std::unique_ptr<JobSource> meshes) const {
    return std::make_unique<CopiesSource>(std::move(meshes), recipients_, arguments_.out);
  }

  const MarkArguments& arguments_;
  OptionValues values_;
  std::shared_ptr<const Recipients> recipients_;  // null: none on the command line
  std::vector<NamedFile> meshes_;
};

// Returns the place of the ledger of the whole run: beside the folder of the marked files, not in
// it, since that folder is handed out; or beside the manifest that names the outputs.
fs::path base_ledger_of(const MarkArguments& arguments) {
  if (!arguments.run.ledger().empty()) return arguments.run.ledger();
  fs::path beside = arguments.out.empty() ? fs::path(arguments.inputs.front()) : arguments.out;
  beside = fs::absolute(beside).lexically_normal();
  if (!beside.has_filename()) beside = beside.parent_path();
  if (!beside.has_filename()) {
    throw Error(ErrorCode::Usage, beside, "", "has no place beside it for a ledger; name --ledger");
  }
  return beside += ".ledger";
}

// Shards have ledgers and records of their own, which merge makes into those of the whole.
fs::path ledger_of(const MarkArguments& arguments) {
  return name_for(shard_of(arguments), base_ledger_of(arguments));
}

fs::path records_of(const MarkArguments& arguments) {
  return name_for(shard_of(arguments), arguments.records);
}

// Returns the ledger of the whole run, if this is a shard and there is one.
std::optional<Ledger>& open_base(const MarkArguments& arguments, std::optional<Ledger>& base) {
  std::error_code ignored;
  const fs::path path = base_ledger_of(arguments);
  if (!shard_of(arguments).is_whole() && fs::exists(path, ignored)) base.emplace(path);
  return base;
}

std::vector<OwnFile> own_files(const MarkArguments& arguments) {
  std::vector<OwnFile> files;
  if (!arguments.key.file().empty()) files.push_back({arguments.key.file(), "the key", false});
  if (has_manifest(arguments)) files.push_back({arguments.inputs[0], "the manifest", false});
  if (!arguments.recipients.empty()) {
    files.push_back({arguments.recipients, "the list of recipients", false});
  }
  const fs::path ledger = ledger_of(arguments);
  files.push_back({ledger, "the ledger", true});
  for (const char* ending : {"-wal", "-shm", "-journal"}) {
    files.push_back({ledger.string() + ending, "a file of the ledger", true});
  }
  if (!arguments.records.empty()) files.push_back({records_of(arguments), "the records", true});
  return files;
}

// Jobs whose meshes are measured in passing.
class MeasuredJobs final : public JobSource {
 public:
  explicit MeasuredJobs(std::unique_ptr<JobSource> jobs) : jobs_(std::move(jobs)) {}
  [[nodiscard]] std::optional<Job> next() override {
    std::optional<Job> job = jobs_->next();
    if (job) bytes_ += bytes_of_file(job->mesh);
    return job;
  }
  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }

 private:
  std::unique_ptr<JobSource> jobs_;
  std::uint64_t bytes_ = 0;
};

// Returns the path of the picture: relative to its directory as the marked file is to its own.
fs::path picture_of(const Record& record, const MarkArguments& arguments) {
  fs::path name = record.file.out.lexically_relative(arguments.out);
  if (name.empty() || *name.begin() == "..") name = record.file.out.filename();
  return arguments.pictures / (name.string() + ".png");
}

std::vector<std::string> renderer_arguments(const MarkArguments& arguments) {
  std::vector<std::string> words = {"--batch"};
  const int threads = arguments.run.threads();
  if (threads > 0) words.insert(words.end(), {"--threads", std::to_string(threads)});
  return words;
}

// What one worker of a run of marking prints, writes and draws.
class MarkReport {
 public:
  MarkReport(const MarkArguments& arguments, const WorkOrder& order, std::size_t total)
      : arguments_(arguments),
        tally_(arguments.run, order, total,
               {file_status_names().begin(), file_status_names().end()}) {
    if (!arguments.records.empty()) records_.emplace(records_of(arguments), !order.is_first);
    if (!arguments.pictures.empty()) pictures_.emplace(renderer_arguments(arguments));
    has_table_ = !arguments.json && !arguments.run.is_quiet();
    if (has_table_ && order.is_first) print_table_heading(std::cout);
  }

  void completed(const Record& record) {
    if (records_) records_->write(record);
  }

  void delivered(const Record& record) {
    const bool failed = !record.file.is_marked();
    tally_.clear_bar();
    if (arguments_.json) std::cout << line_of(record);
    if (has_table_) print_table_row(std::cout, record);
    std::cout.flush();  // what is delivered must outlive this worker
    if (!record.file.error.empty()) {
      std::cerr << "triglyph: " << printable(record.file.error) << "\n";
    }
    tally_.count(static_cast<std::size_t>(record.file.status), failed, record.is_kept,
                 record.file.mesh);
    if (pictures_ && !failed && wants_picture(record)) {
      pictures_->draw(record.file.mesh, record.file.out, picture_of(record, arguments_));
    }
  }

  // Waits for pictures, and returns the exit code.
  int finish(bool stopped) {
    tally_.clear_bar();
    if (records_) records_->finish();
    if (pictures_ && stopped) pictures_->stop();
    bool all_drawn = true;
    if (pictures_ && pictures_->finish() != std::size_t{0}) {
      std::cerr << "triglyph: not all pictures were drawn\n";
      all_drawn = false;
    }
    const int code = tally_.finish("mesh", "meshes");
    return code == kDone && !all_drawn ? kSomeFailed : code;
  }

 private:
  // The picture of a mesh that an earlier run marked is there already.
  [[nodiscard]] bool wants_picture(const Record& record) const {
    std::error_code ignored;
    return !record.is_kept || !fs::exists(picture_of(record, arguments_), ignored);
  }

  const MarkArguments& arguments_;
  RunTally tally_;
  std::optional<RecordsFile> records_;
  std::optional<RenderBatch> pictures_;
  bool has_table_ = false;
};

int print_plan(const MarkArguments& arguments, const Jobs& jobs, const Key& key) {
  (void)check_plan(*jobs.open(), own_files(arguments));
  const fs::path path = ledger_of(arguments);
  const Shard shard = shard_of(arguments);
  std::optional<Ledger> ledger;
  std::optional<Ledger> base;
  std::optional<Resume> resume;
  std::error_code ignored;
  if (fs::exists(path, ignored)) {
    resume.emplace(ledger.emplace(path), 0, key, arguments.resume,
                   open_base(arguments, base) ? &*base : nullptr);
  } else if (open_base(arguments, base)) {
    resume.emplace(*base, 0, key, arguments.resume);
  }
  std::size_t marked = 0;
  std::size_t kept = 0;
  std::size_t refused = 0;
  const auto print = [&](const Job& job, const Decision& decision) {
    const bool keeps = decision.kind == Decision::Kind::Keep;
    const bool refuses = decision.kind == Decision::Kind::Refuse;
    ++(keeps ? kept : refuses ? refused : marked);
    const char* verb = keeps ? "keep" : refuses ? "refuse" : "mark";
    if (arguments.json) {
      nlohmann::ordered_json json = {{"plan", verb}};
      put_path(json, "mesh", job.mesh);
      put_path(json, "out", job.out);
      json["scheme"] = job.request.options.scheme_name();
      if (!decision.reason.empty()) json["reason"] = decision.reason;
      std::cout << to_line(json);
      return;
    }
    std::cout << verb << " " << printable(job.mesh.string()) << " -> "
              << printable(job.out.string());
    if (!decision.reason.empty()) std::cout << " (" << printable(decision.reason) << ")";
    std::cout << "\n";
  };
  const std::atomic<bool> stop{false};
  const auto source = jobs.open(shard, jobs.plan_of(shard));
  if (resume) {
    plan_jobs(*source, *resume, print, stop);
  } else {
    while (const std::optional<Job> job = source->next()) print(*job, {});
  }
  if (!arguments.run.is_quiet()) {
    std::cerr << "triglyph: " << marked << " to mark, " << kept << " to keep, " << refused
              << " to refuse\n";
  }
  return refused == 0 ? kDone : kSomeFailed;
}

std::size_t count_jobs(JobSource& jobs) {
  std::size_t count = 0;
  while (jobs.next()) ++count;
  return count;
}

int mark_share(const MarkArguments& arguments, const Jobs& jobs, const Key& key,
               const WorkOrder& order) {
  // a worker that came before has checked the plan and left its size
  std::atomic<std::uint64_t>& total = order.board->total;
  const Shard shard = shard_of(arguments);
  const ShardPlan plan = jobs.plan_of(shard);
  if (order.is_first) {
    if (!shard.is_whole()) (void)check_plan(*jobs.open(), own_files(arguments));
    MeasuredJobs measured(jobs.open(shard, plan));
    total = shard.is_whole() ? check_plan(measured, own_files(arguments)) : count_jobs(measured);
    order.board->total_bytes = measured.bytes();
  }
  Ledger ledger(ledger_of(arguments));
  std::optional<Ledger> base;
  const LoggedRun run(&ledger, order, "mark");
  const Resume resume(ledger, run.id(), key, arguments.resume,
                      open_base(arguments, base) ? &*base : nullptr);
  RunContext context = arguments.run.context(order);
  context.shard = shard;
  context.jobs_of_all = plan.jobs;
  context.resume = &resume;
  context.copies_companions = arguments.companions;
  context.keeps_shapes = !arguments.no_shapes;
  context.keeps_times = arguments.keep_times;
  const auto source = jobs.open(shard, plan);
  const std::atomic<bool>& stop = order.board->stop();
  if (order.only) {
    run_jobs(*source, key, context, {}, stop);
    return kDone;
  }
  MarkReport report(arguments, order, total);
  run_jobs(*source, key, context,
           {.completed = [&](const Record& record) { report.completed(record); },
            .delivered = [&](const Record& record) { report.delivered(record); }},
           stop);
  const int code = report.finish(stop);
  run.end(code);
  return code;
}

int run_mark(const MarkArguments& arguments) {
  const Key key = arguments.key.load();
  (void)shard_of(arguments);  // a mistake is to be known before the run
  const Jobs jobs(arguments);
  if (arguments.dry_run) return print_plan(arguments, jobs, key);
  return arguments.run.supervised(
      {"mark", {file_status_names().begin(), file_status_names().end()}},
      [&](const WorkOrder& order) { return mark_share(arguments, jobs, key, order); });
}

}  // namespace

void add_mark_verb(CLI::App& app, Action& action) {
  CLI::App* verb = app.add_subcommand("mark", "Hide a message in meshes");
  auto arguments = std::make_shared<MarkArguments>();
  verb->add_option("inputs", arguments->inputs,
                   "A manifest (.jsonl), or meshes, folders, globs, or - for a list on standard "
                   "input")
      ->required()
      ->type_name("MANIFEST|INPUT");
  verb->add_option("--out", arguments->out, "Directory for the marked files")->type_name("DIR");
  add_declared_options(*verb, mark_option_specs(), arguments->values);
  verb->add_option(
          "--recipients", arguments->recipients,
          "Make a copy of every mesh for each name of this list, a line each, or the first "
          "field of each line of a .csv file")
      ->type_name("FILE");
  verb->add_option("--records", arguments->records, "Write one JSON record per mesh to this file")
      ->type_name("FILE");
  verb->add_option("--shard", arguments->shard,
                   "Mark part I of N alone, with a ledger and records of its own "
                   "(name.shard-I-of-N); merge makes those of all parts into one")
      ->type_name("I/N");
  verb->add_option("--render", arguments->pictures,
                   "Draw a picture that compares each mesh with its marked copy, in this directory")
      ->type_name("DIR");
  verb->add_flag("--json", arguments->json, "Print the records instead of a table");
  verb->add_flag("--force", arguments->resume.force,
                 "Mark every mesh, also those that an earlier run marked as asked, and replace "
                 "outputs made from other meshes");
  verb->add_flag("--no-clobber", arguments->resume.no_clobber,
                 "Keep existing files that the ledger does not know");
  verb->add_flag("--companions", arguments->companions,
                 "Copy the material libraries and textures that a mesh names beside its output");
  verb->add_flag("--keep-times", arguments->keep_times,
                 "Give each output the modification time of its mesh");
  verb->add_flag("--no-shapes", arguments->no_shapes,
                 "Keep no coarse shape of a mesh in the ledger when copies are made of it; cropped "
                 "copies are then traced with the mesh alone");
  verb->add_flag("--dry-run", arguments->dry_run, "Print what would be done, and do nothing");
  arguments->key.add_to(*verb);
  arguments->run.add_to(*verb);
  verb->footer(
      "Hide a message in some meshes, and keep what is needed to verify them:\n"
      "  triglyph mark a.obj b.ply --out marked --message \"for Ada\" --key-file owner.key "
      "--records run.jsonl\n"
      "Mark what a manifest lists, with its own options for each mesh; the same command again does "
      "only what is missing or has changed:\n"
      "  triglyph mark collection.jsonl --out marked --key-file owner.key");
  verb->callback([&action, arguments] { action = [arguments] { return run_mark(*arguments); }; });
}

}  // namespace triglyph
