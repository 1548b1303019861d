#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "cli/app.h"
#include "cli/run_arguments.h"
#include "cli/verbs.h"
#include "engine/base/error.h"
#include "manifests/json_line.h"
#include "manifests/ledger.h"
#include "manifests/records_file.h"
#include "manifests/resume.h"

namespace triglyph {
namespace {

namespace fs = std::filesystem;

struct LedgerArguments {
  std::string action;
  fs::path ledger;
  std::vector<fs::path> records;
};

void export_items(const Ledger& ledger) {
  std::string last;
  while (std::optional<LedgerItem> item = ledger.find_after(last)) {
    std::cout << item->record << "\n";
    check_standard_output();
    last = std::move(item->target);
  }
}

void list_marks(const Ledger& ledger) {
  ledger.for_each_mark([](const LedgerMark& mark) {
    nlohmann::ordered_json json = {{"mark", mark.number}};
    put_path(json, "mesh", mark.mesh);
    put_path(json, "out", mark.out);
    json["scheme"] = mark.scheme;
    json["message_hex"] = mark.message_hex;
    if (!mark.recipient.empty()) json["recipient"] = mark.recipient;
    json["key"] = mark.key;
    json["input_hash"] = mark.input_hash;
    json["output_hash"] = mark.output_hash;
    json["issued"] = mark.issued;
    std::cout << to_line(json);
    check_standard_output();
  });
}

void list_runs(const Ledger& ledger) {
  ledger.for_each_run([](const LedgerRun& run) {
    nlohmann::ordered_json json = {{"run", run.id}, {"verb", run.verb}, {"started", run.started}};
    if (!run.ended.empty()) json["ended"] = run.ended;
    json["outcome"] = run.ended.empty() ? "did not end" : run.outcome;
    put_path(json, "directory", run.directory);
    put_path(json, "command", run.command);
    json["version"] = run.version;
    std::cout << to_line(json);
    check_standard_output();
  });
}

void list_results(const Ledger& ledger) {
  ledger.for_each_result([](const LedgerResult& result) {
    nlohmann::ordered_json json = {{"run", result.run}, {"place", result.place}};
    put_path(json, "file", result.file);
    json["status"] = result.status;
    json["result"] = parse_json_line(result.line);
    std::cout << to_line(json);
    check_standard_output();
  });
}

void import_records(Ledger& ledger, const std::vector<fs::path>& files) {
  LedgerRun run;
  run.verb = "import";
  run.version = TRIGLYPH_VERSION;
  run.directory = fs::current_path().string();
  const std::int64_t id = ledger.begin_run(run);
  std::size_t count = 0;
  for (const fs::path& file : files) {
    const auto next = record_source(file);
    while (std::optional<Record> record = next()) {
      record->file.mesh = resolved(record->file.mesh, *record);
      record->file.out = resolved(record->file.out, *record);
      record->task = task_hash(record->file.request);
      enter_record(ledger, id, *record);
      ++count;
    }
  }
  ledger.end_run(id, "done");
  std::cout << count << " records imported\n";
}

int run_ledger(const LedgerArguments& arguments) {
  const bool imports = arguments.action == "import";
  if (imports == arguments.records.empty()) {
    throw Error(
        ErrorCode::Usage, {}, "",
        imports ? "name the files of records to import" : "only import takes files of records");
  }
  if (!imports && !is_ledger_file(arguments.ledger)) {
    throw Error(ErrorCode::Unreadable, arguments.ledger, "", "is no ledger");
  }
  Ledger ledger(arguments.ledger);
  if (arguments.action == "export") export_items(ledger);
  if (arguments.action == "marks") list_marks(ledger);
  if (arguments.action == "runs") list_runs(ledger);
  if (arguments.action == "results") list_results(ledger);
  if (imports) import_records(ledger, arguments.records);
  return kDone;
}

}  // namespace

void add_ledger_verb(CLI::App& app, Action& action) {
  CLI::App* verb = app.add_subcommand(
      "ledger", "Print what a ledger remembers, one JSON object per line, or add records to it");
  auto arguments = std::make_shared<LedgerArguments>();
  verb->add_option(
          "action", arguments->action,
          "export: the records of all outputs by name; marks: every mark issued; runs: "
          "every run; results: what extract, verify, measure and render found; import: add "
          "files of records")
      ->required()
      ->check(CLI::IsMember({"export", "marks", "runs", "results", "import"}).description(""))
      ->type_name("export|marks|runs|results|import");
  verb->add_option("ledger", arguments->ledger, "The ledger")->required()->type_name("LEDGER");
  verb->add_option("records", arguments->records, "Files of records to import")
      ->type_name("RECORDS");
  verb->footer(
      "Keep the records of all that was ever marked:\n"
      "  triglyph ledger export marked.ledger > records.jsonl\n"
      "Give a ledger what earlier runs recorded:\n"
      "  triglyph ledger import marked.ledger run.jsonl");
  verb->callback([&action, arguments] { action = [arguments] { return run_ledger(*arguments); }; });
}

}  // namespace triglyph
