#include <deque>
#include <iostream>
#include <memory>

#include "cli/app.h"
#include "cli/options.h"
#include "cli/run_arguments.h"
#include "cli/screen.h"
#include "cli/verbs.h"
#include "engine/base/error.h"
#include "engine/base/text.h"
#include "manifests/file_runs.h"
#include "manifests/inputs.h"
#include "manifests/json_line.h"
#include "manifests/records_file.h"
#include "manifests/resume.h"

namespace triglyph {
namespace {

namespace fs = std::filesystem;

struct VerifyArguments {
  std::vector<std::string> inputs;
  fs::path root;
  bool json = false;
  bool detail = false;
  KeyArgument key;
  RunArguments run;
};

// Returns the records of all files of records and ledgers, one after another.
RecordSource records_in(std::span<const std::string> inputs) {
  auto sources = std::make_shared<std::deque<RecordSource>>();
  for (const std::string& input : inputs) sources->push_back(record_source(input));
  return [sources]() -> std::optional<Record> {
    while (!sources->empty()) {
      if (std::optional<Record> record = sources->front()()) return record;
      sources->pop_front();
    }
    return std::nullopt;
  };
}

// Returns the records that the ledger has of the files; for a file that it does not know, one that
// is not marked.
RecordSource records_of(const std::vector<fs::path>& files, const fs::path& ledger_path) {
  auto ledger = std::make_shared<Ledger>(ledger_path);
  auto next = std::make_shared<std::size_t>(0);
  return [files, ledger, next]() -> std::optional<Record> {
    if (*next == files.size()) return std::nullopt;
    const fs::path& file = files[(*next)++];
    const std::optional<LedgerItem> item = ledger->find(canonical_name(file));
    Record record;
    if (item) record = parse_record(item->record);
    record.file.out = file;
    return record;
  };
}

// Returns the file of a record: below --root, else where the run stood.
fs::path file_of(const Record& record, const fs::path& root) {
  const fs::path& out = record.file.out;
  return root.empty() || out.is_absolute() ? resolved(out, record) : root / out;
}

// Returns ascending numbers as ranges: "3-17 20 22-24".
std::string ranges(const std::vector<std::uint64_t>& numbers) {
  std::string text;
  for (std::size_t i = 0; i < numbers.size();) {
    std::size_t end = i + 1;
    while (end < numbers.size() && numbers[end] == numbers[end - 1] + 1) ++end;
    if (!text.empty()) text += ' ';
    text += std::to_string(numbers[i]);
    if (end - i > 1) text += '-' + std::to_string(numbers[end - 1]);
    i = end;
  }
  return text;
}

void print_damage(const Verification& found) {
  const bool readable = found.verdict == FileVerdict::Intact ||
                        found.verdict == FileVerdict::Altered || found.verdict == FileVerdict::Lost;
  if (!found.damage) {
    if (readable)
      std::cout << "  damage cannot be located: no units in the record, or renumbered\n";
    return;
  }
  std::cout << "  " << found.damage->units_damaged << " of " << found.damage->units_expected
            << " units damaged";
  if (!found.damage->vertices.empty()) {
    std::cout << ", at " << found.damage->vertices.size()
              << " vertices: " << ranges(found.damage->vertices);
  }
  std::cout << "\n";
}

nlohmann::ordered_json json_of(const Record& record, const Verification& found) {
  nlohmann::ordered_json json;
  put_path(json, "out", record.file.out);
  json["verdict"] = name_of(found.verdict);
  json["units_recorded"] = record.file.units_embedded;
  json["units_found"] = found.units_found;
  if (!found.detail.empty()) json["detail"] = found.detail;
  if (found.damage) {
    json["damage"] = {{"units_expected", found.damage->units_expected},
                      {"units_damaged", found.damage->units_damaged},
                      {"vertices", found.damage->vertices}};
  }
  return json;
}

void print(const VerifyArguments& arguments, const Record& record, const Verification& found) {
  if (arguments.json) {
    std::cout << to_line(json_of(record, found));
    return;
  }
  std::cout << printable(record.file.out.string()) << ": " << name_of(found.verdict) << ", "
            << found.units_found << " of " << record.file.units_embedded << " units";
  if (!found.detail.empty()) std::cout << " (" << printable(found.detail) << ")";
  std::cout << "\n";
  if (arguments.detail) print_damage(found);
}

std::vector<std::string_view> verdict_names() {
  std::vector<std::string_view> names;
  for (int verdict = 0; verdict <= static_cast<int>(FileVerdict::NotMarked); ++verdict) {
    names.push_back(name_of(static_cast<FileVerdict>(verdict)));
  }
  return names;
}

int run_verify(const VerifyArguments& arguments) {
  const Key key = arguments.key.load();
  // without a ledger the inputs are records; with one they are files that it knows, or all
  const fs::path& ledger = arguments.run.ledger();
  if (arguments.inputs.empty() && ledger.empty()) {
    throw Error(ErrorCode::Usage, {}, "", "name files of records, or --ledger");
  }
  std::vector<std::string> inputs = arguments.inputs;
  std::vector<fs::path> files;
  if (!ledger.empty() && !inputs.empty()) files = gather_files(inputs, std::cin);
  if (inputs.empty()) inputs = {ledger.string()};
  if (!ledger.empty() && !is_ledger_file(ledger)) {
    throw Error(ErrorCode::Unreadable, ledger, "", "is no ledger");
  }
  return arguments.run.supervised({"verify", verdict_names()}, [&](const WorkOrder& order) {
    const RecordSource records = files.empty() ? records_in(inputs) : records_of(files, ledger);
    RunTally tally(arguments.run, order, 0, verdict_names());
    std::optional<Ledger> log;
    if (!ledger.empty()) log.emplace(ledger);
    const LoggedRun run(log ? &*log : nullptr, order, "verify");
    const auto next = [&]() -> std::optional<Record> {
      std::optional<Record> record = records();
      if (record) record->file.out = file_of(*record, arguments.root);
      return record;
    };
    verify_files(
        next, key, arguments.detail, arguments.run.context(order),
        [&](const Record& record, const Verification& found) {
          tally.clear_bar();
          print(arguments, record, found);
          check_standard_output();  // nobody is there to read the rest
          run.note(record.file.out, name_of(found.verdict), json_of(record, found));
          // who asks for a file by its name expects a mark in it
          const bool good = found.verdict == FileVerdict::Intact ||
                            (files.empty() && found.verdict == FileVerdict::NotMarked);
          tally.count(static_cast<std::size_t>(found.verdict), !good, false, record.file.out);
        },
        order.board->stop());
    if (order.only) return kDone;
    const int code = tally.finish("file", "files");
    run.end(code);
    return code;
  });
}

}  // namespace

void add_verify_verb(CLI::App& app, Action& action) {
  CLI::App* verb = app.add_subcommand(
      "verify",
      "Check that the marked files of a run exist, are unchanged and carry their message");
  auto arguments = std::make_shared<VerifyArguments>();
  verb->add_option("inputs", arguments->inputs,
                   "Records written by mark --records, or ledgers; with --ledger, the files, "
                   "folders, globs or - that it is asked about (default: all)")
      ->type_name("RECORDS|INPUT");
  verb->add_option("--root", arguments->root,
                   "Look for files with relative names below this directory (default: where the "
                   "run stood)")
      ->type_name("DIR");
  verb->add_flag("--json", arguments->json, "Print one JSON object per record");
  verb->add_flag(
      "--detail", arguments->detail,
      "Report which units are damaged, and where, if the record lists units (always with iie; "
      "otherwise with mark --detail)");
  arguments->key.add_to(*verb);
  arguments->run.add_to(*verb);
  verb->footer(
      "Check the files of a run, and name the vertices of damaged units:\n"
      "  triglyph verify run.jsonl --key-file owner.key --detail\n"
      "Check all that a ledger knows:\n"
      "  triglyph verify --ledger marked.ledger --key-file owner.key");
  verb->callback([&action, arguments] { action = [arguments] { return run_verify(*arguments); }; });
}

}  // namespace triglyph
