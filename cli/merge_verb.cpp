#include <iostream>
#include <memory>

#include "cli/app.h"
#include "cli/run_arguments.h"
#include "cli/verbs.h"
#include "engine/base/error.h"
#include "manifests/merge.h"

namespace triglyph {
namespace {

namespace fs = std::filesystem;

struct MergeArguments {
  std::vector<fs::path> inputs;
  fs::path ledger;
  fs::path records;
};

// Throws Error Usage if a result would replace what it is made of.
void check_is_no_input(const fs::path& out, const std::vector<fs::path>& inputs) {
  for (const fs::path& input : inputs) {
    std::error_code ignored;
    if (input == out || fs::equivalent(input, out, ignored)) {
      throw Error(ErrorCode::Usage, out, "", "is one of the inputs; name another file");
    }
  }
}

std::string places_of(const std::vector<Gap>& gaps) {
  constexpr std::size_t kMostShown = 10;
  std::string text;
  for (std::size_t i = 0; i < std::min(gaps.size(), kMostShown); ++i) {
    text.append(i == 0 ? "" : ", ").append(std::to_string(gaps[i].first));
    if (gaps[i].last > gaps[i].first) text.append(" to ").append(std::to_string(gaps[i].last));
  }
  return gaps.size() > kMostShown ? text.append(", ..") : text;
}

int run_merge(const MergeArguments& arguments) {
  std::vector<fs::path> ledgers;
  std::vector<fs::path> records;
  for (const fs::path& input : arguments.inputs) {
    (is_ledger_file(input) ? ledgers : records).push_back(input);
  }
  const auto expect = [](const fs::path& out, bool has_inputs, const char* option,
                         const char* what) {
    if (out.empty() == !has_inputs) return;
    const std::string have = has_inputs ? "there are " : "there are no ";
    throw Error(ErrorCode::Usage, {}, "",
                have + what + " among the inputs, " + (has_inputs ? "but no " : "for ") + option);
  };
  expect(arguments.ledger, !ledgers.empty(), "--ledger", "ledgers");
  expect(arguments.records, !records.empty(), "--records", "records");
  check_is_no_input(arguments.ledger, arguments.inputs);
  check_is_no_input(arguments.records, arguments.inputs);
  int code = kDone;
  if (!records.empty()) {
    const MergedRecords merged = merge_records(records, arguments.records);
    std::cout << merged.records << " records merged\n";
    if (!merged.gaps.empty()) {
      std::cerr << "triglyph: no records of places " << places_of(merged.gaps)
                << ": shards are missing or did not come to their end\n";
      code = kSomeFailed;
    }
  }
  if (!ledgers.empty()) {
    Ledger out(arguments.ledger);
    merge_ledgers(ledgers, out);
    std::cout << ledgers.size() << (ledgers.size() == 1 ? " ledger" : " ledgers") << " merged\n";
  }
  return code;
}

}  // namespace

void add_merge_verb(CLI::App& app, Action& action) {
  CLI::App* verb = app.add_subcommand(
      "merge", "Make the ledgers and records of the shards of a run into those of the whole");
  auto arguments = std::make_shared<MergeArguments>();
  verb->add_option("inputs", arguments->inputs, "Ledgers and files of records, in any order")
      ->required()
      ->type_name("LEDGER|RECORDS");
  verb->add_option("--ledger", arguments->ledger,
                   "The ledger to enter all ledgers into; what it knows already stays")
      ->type_name("FILE");
  verb->add_option("--records", arguments->records,
                   "The file to write all records to, in the order of the whole run")
      ->type_name("FILE");
  verb->footer(
      "Mark a collection on three machines that see the same files, and make it one run; exit code "
      "3 tells that something is missing:\n"
      "  triglyph mark lib.jsonl --out marked --key-file owner.key --records run.jsonl --shard "
      "1/3\n"
      "  (2/3 and 3/3 on the others)\n"
      "  triglyph merge marked.shard-*.ledger run.shard-*.jsonl --ledger marked.ledger --records "
      "run.jsonl");
  verb->callback([&action, arguments] { action = [arguments] { return run_merge(*arguments); }; });
}

}  // namespace triglyph
