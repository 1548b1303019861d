#include <algorithm>
#include <cmath>
#include <fstream>
#include <iostream>
#include <memory>

#include "cli/app.h"
#include "cli/options.h"
#include "cli/screen.h"
#include "cli/verbs.h"
#include "engine/base/error.h"
#include "engine/base/parallel.h"
#include "manifests/inputs.h"
#include "manifests/json_line.h"
#include "manifests/run.h"

namespace triglyph {
namespace {

struct ExtractArguments {
  std::vector<std::string> inputs;
  std::filesystem::path like;  // records
  bool json = false;
  OptionValues values;
  KeysArgument keys;
  MachineArguments machine;
};

// Returns printable text unchanged, anything else in hexadecimal.
std::string shown(const Message& message) {
  const bool printable = std::all_of(message.begin(), message.end(),
                                     [](std::uint8_t byte) { return byte >= 32 && byte < 127; });
  return printable ? "\"" + std::string(message.begin(), message.end()) + "\""
                   : "0x" + to_hex(message);
}

// Returns the exponent of the least power of two that is not below the probability.
int power_of_two_above(double chance) {
  return static_cast<int>(std::ceil(std::log2(chance)));
}

void print_text(const std::filesystem::path& path, const FileReading& reading,
                std::span<const Key> keys) {
  std::cout << path.string() << ": ";
  if (!reading.mark) {
    std::cout << "no mark\n";
    return;
  }
  const FoundMark& mark = *reading.mark;
  std::cout << shown(mark.message) << "  " << mark.encoding.scheme << ", " << mark.agreeing
            << " units agree, " << mark.parts << " parts, false alarm 2^"
            << power_of_two_above(reading.false_alarm);
  if (keys.size() > 1) std::cout << ", key " << keys[mark.key].fingerprint();
  std::cout << "\n";
}

void print_json(const std::filesystem::path& path, const FileReading& reading,
                std::span<const Key> keys) {
  nlohmann::ordered_json json = {{"mesh", path.string()},
                                 {"status", reading.mark ? "marked" : "no mark"},
                                 {"vertices", reading.vertices},
                                 {"faces", reading.faces},
                                 {"units_with_marker", reading.units_with_marker},
                                 {"false_alarm_bound", reading.false_alarm}};
  if (reading.mark) {
    const FoundMark& mark = *reading.mark;
    json["message_hex"] = to_hex(mark.message);
    json["scheme"] = mark.encoding.scheme;
    json["key"] = keys[mark.key].fingerprint();
    json["parts"] = mark.parts;
    json["units_agreeing"] = mark.agreeing;
    json["agreement"] = mark.agreement;
  }
  std::cout << to_line(json);
}

// Prints results as they arrive, and keeps track of the exit code.
class ResultPrinter {
 public:
  ResultPrinter(std::span<const Key> keys, bool json) : keys_(keys), json_(json) {}

  void print(const ReadResult& result) {
    if (result.reading) {
      all_marked_ = all_marked_ && result.reading->mark.has_value();
      json_ ? print_json(result.path, *result.reading, keys_)
            : print_text(result.path, *result.reading, keys_);
      return;
    }
    all_readable_ = false;
    std::cerr << "triglyph: " << result.error << "\n";
    if (!json_) return;
    std::cout << to_line({{"mesh", result.path.string()},
                          {"status", name_of(*result.status)},
                          {"error", result.error}});
  }

  [[nodiscard]] int exit_code() const {
    if (!all_readable_) return kSomeFailed;
    return all_marked_ ? kDone : kNoMark;
  }

 private:
  std::span<const Key> keys_;
  bool json_;
  bool all_marked_ = true;
  bool all_readable_ = true;
};

// Returns the distinct encodings of the marks in a file of records.
std::vector<Encoding> encodings_in(const std::filesystem::path& records) {
  std::ifstream stream(records);
  if (std::filesystem::is_directory(records) || !stream) {
    throw Error(ErrorCode::Unreadable, records, "", "the records cannot be read");
  }
  std::vector<Encoding> encodings;
  std::size_t number = 0;
  for (std::string line; std::getline(stream, line);) {
    ++number;
    try {
      const Record record = parse_record(line);
      if (!record.file.is_marked() || record.file.request.is_fill()) continue;
      Encoding encoding = record.file.encoding();
      if (std::find(encodings.begin(), encodings.end(), encoding) == encodings.end()) {
        encodings.push_back(std::move(encoding));
      }
    } catch (const Error& error) {
      throw Error(ErrorCode::Malformed, records, at_line(number), error.message());
    }
  }
  return encodings;
}

int run_extract(const ExtractArguments& arguments) {
  const std::vector<Key> keys = arguments.keys.load();
  if (arguments.values.contains("scheme")) {
    check_contradictions(arguments.values, scheme_of(arguments.values));
  }
  std::vector<Encoding> encodings = encodings_of(arguments.values);
  if (!arguments.like.empty()) {
    std::vector<Encoding> recorded = encodings_in(arguments.like);
    for (Encoding& encoding : encodings) {
      if (std::find(recorded.begin(), recorded.end(), encoding) == recorded.end()) {
        recorded.push_back(std::move(encoding));
      }
    }
    encodings = std::move(recorded);
  }
  const std::vector<std::filesystem::path> files = gather_files(arguments.inputs, std::cin);
  ResultPrinter printer(keys, arguments.json);
  const std::atomic<bool>& stop = interrupt_flag();
  FlowOptions options;
  options.memory_bytes = arguments.machine.memory_bytes();
  with_threads(arguments.machine.threads(), [&] {
    read_files(
        files, encodings, keys, options, [&](const ReadResult& result) { printer.print(result); },
        stop);
  });
  return stop ? kInterrupted : printer.exit_code();
}

}  // namespace

void add_extract_verb(CLI::App& app, Action& action) {
  CLI::App* verb = app.add_subcommand("extract", "Read the message from meshes, blind");
  auto arguments = std::make_shared<ExtractArguments>();
  verb->add_option("inputs", arguments->inputs,
                   "Meshes, folders, globs, manifests (.jsonl), or - for a list on standard input")
      ->required()
      ->type_name("INPUT");
  verb->add_option("--like", arguments->like,
                   "Also try the schemes and options with which these records were marked")
      ->type_name("RECORDS");
  verb->add_flag("--json", arguments->json, "Print one JSON object per mesh");
  add_declared_options(*verb, encoding_option_specs(), arguments->values);
  arguments->keys.add_to(*verb);
  arguments->machine.add_threads_to(*verb);
  arguments->machine.add_memory_to(*verb);
  verb->footer(
      "Look for a mark in every mesh below a directory, under two keys:\n"
      "  triglyph extract found/ --key-file owner.key --key-file former.key");
  verb->callback(
      [&action, arguments] { action = [arguments] { return run_extract(*arguments); }; });
}

}  // namespace triglyph
