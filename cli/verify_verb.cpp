#include <fstream>
#include <iostream>
#include <memory>

#include "cli/app.h"
#include "cli/options.h"
#include "cli/screen.h"
#include "cli/verbs.h"
#include "engine/base/error.h"
#include "engine/base/parallel.h"
#include "manifests/json_line.h"
#include "manifests/run.h"

namespace triglyph {
namespace {

struct VerifyArguments {
  std::filesystem::path records;
  bool json = false;
  bool detail = false;
  KeyArgument key;
  MachineArguments machine;
};

Record parse_line(const VerifyArguments& arguments, const std::string& line,
                  std::size_t number) try {
  return parse_record(line);
} catch (const Error& error) {
  throw Error(ErrorCode::Malformed, arguments.records, at_line(number), error.message());
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

void print(const VerifyArguments& arguments, const Record& record, const Verification& found) {
  if (arguments.json) {
    nlohmann::ordered_json json = {{"out", record.file.out.string()},
                                   {"verdict", name_of(found.verdict)},
                                   {"units_recorded", record.file.units_embedded},
                                   {"units_found", found.units_found}};
    if (!found.detail.empty()) json["detail"] = found.detail;
    if (found.damage) {
      json["damage"] = {{"units_expected", found.damage->units_expected},
                        {"units_damaged", found.damage->units_damaged},
                        {"vertices", found.damage->vertices}};
    }
    std::cout << to_line(json);
    return;
  }
  std::cout << record.file.out.string() << ": " << name_of(found.verdict) << ", "
            << found.units_found << " of " << record.file.units_embedded << " units";
  if (!found.detail.empty()) std::cout << " (" << found.detail << ")";
  std::cout << "\n";
  if (arguments.detail) print_damage(found);
}

int run_verify(const VerifyArguments& arguments) {
  const Key key = arguments.key.load();
  std::ifstream stream(arguments.records);
  if (std::filesystem::is_directory(arguments.records) || !stream) {
    throw Error(ErrorCode::Unreadable, arguments.records, "", "the records cannot be read");
  }
  std::size_t number = 0;
  const auto next_record = [&]() -> std::optional<Record> {
    std::string line;
    if (!std::getline(stream, line)) return std::nullopt;
    return parse_line(arguments, line, ++number);
  };
  bool all_good = true;
  const std::atomic<bool>& stop = interrupt_flag();
  FlowOptions options;
  options.memory_bytes = arguments.machine.memory_bytes();
  with_threads(arguments.machine.threads(), [&] {
    verify_files(
        next_record, key, arguments.detail, options,
        [&](const Record& record, const Verification& found) {
          all_good = all_good && (found.verdict == FileVerdict::Intact ||
                                  found.verdict == FileVerdict::NotMarked);
          print(arguments, record, found);
        },
        stop);
  });
  if (stop) return kInterrupted;
  return all_good ? kDone : kSomeFailed;
}

}  // namespace

void add_verify_verb(CLI::App& app, Action& action) {
  CLI::App* verb = app.add_subcommand(
      "verify",
      "Check that the marked files of a run exist, are unchanged and carry their message");
  auto arguments = std::make_shared<VerifyArguments>();
  verb->add_option("records", arguments->records, "Records written by mark --records")
      ->required()
      ->type_name("RECORDS");
  verb->add_flag("--json", arguments->json, "Print one JSON object per record");
  verb->add_flag(
      "--detail", arguments->detail,
      "Report which units are damaged, and where, if the record lists units (always with iie; "
      "otherwise with mark --detail)");
  arguments->key.add_to(*verb);
  arguments->machine.add_threads_to(*verb);
  arguments->machine.add_memory_to(*verb);
  verb->footer(
      "Check the files of a run, and name the vertices of damaged units:\n"
      "  triglyph verify run.jsonl --key-file owner.key --detail");
  verb->callback([&action, arguments] { action = [arguments] { return run_verify(*arguments); }; });
}

}  // namespace triglyph
