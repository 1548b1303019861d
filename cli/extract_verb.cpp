#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <set>

#include "cli/app.h"
#include "cli/options.h"
#include "cli/run_arguments.h"
#include "cli/screen.h"
#include "cli/verbs.h"
#include "engine/base/text.h"
#include "engine/flux/flux_mark.h"
#include "manifests/file_runs.h"
#include "manifests/inputs.h"
#include "manifests/json_line.h"
#include "manifests/records_file.h"

namespace triglyph {
namespace {

struct ExtractArguments {
  std::vector<std::string> inputs;
  std::filesystem::path like;  // records
  bool json = false;
  OptionValues values;
  KeysArgument keys;
  RunArguments run;
};

// The messages that an owner hid, by which the numbers of flux layers are told.
using KnownMessages = std::set<Message>;

// Returns the messages of the marks in a ledger.
KnownMessages messages_in(const Ledger& ledger) {
  KnownMessages messages;
  ledger.for_each_mark([&](const LedgerMark& mark) {
    if (!mark.message_hex.empty()) messages.insert(from_hex(mark.message_hex));
  });
  return messages;
}

// Enters the message that a number stands for, if it is known. Of several that share a number, none
// is: 16 bits tell few apart.
void resolve_number(const KnownMessages& known, std::span<const Key> keys, FileReading& reading) {
  if (!reading.mark || !reading.mark->flux || !reading.mark->message.empty()) return;
  FoundMark& mark = *reading.mark;
  const auto stands = [&](const Message& message) {
    return stands_for(mark.flux->payload, message, keys[mark.key]);
  };
  const auto found = std::find_if(known.begin(), known.end(), stands);
  if (found == known.end()) return;
  if (std::find_if(std::next(found), known.end(), stands) == known.end()) mark.message = *found;
}

// Returns the exponent of the least power of two that is not below the probability.
int power_of_two_above(double chance) {
  return static_cast<int>(std::ceil(std::log2(chance)));
}

void print_text(const std::filesystem::path& path, const FileReading& reading,
                std::span<const Key> keys) {
  std::cout << printable(path.string()) << ": ";
  if (!reading.mark) {
    std::cout << "no mark\n";
    return;
  }
  const FoundMark& mark = *reading.mark;
  std::cout << (mark.message.empty() ? shown(mark.flux->payload) : shown(mark.message)) << "  "
            << mark.encoding.scheme << ", ";
  if (mark.flux) {
    std::cout << mark.flux->payload.bits << " bits";
    if (!mark.flux->undone.empty()) std::cout << ", " << mark.flux->undone << " undone";
  } else {
    std::cout << mark.agreeing << " units agree, " << mark.parts << " parts";
  }
  std::cout << ", false alarm 2^" << power_of_two_above(reading.false_alarm);
  if (keys.size() > 1) std::cout << ", key " << keys[mark.key].fingerprint();
  std::cout << "\n";
}

std::string_view status_of(const ReadResult& result) {
  if (!result.reading) return name_of(result.failure->status);
  return result.reading->mark ? "marked" : "no mark";
}

nlohmann::ordered_json json_of(const ReadResult& result, std::span<const Key> keys) {
  nlohmann::ordered_json json;
  put_path(json, "mesh", result.path);
  json["status"] = status_of(result);
  if (!result.reading) {
    json["error"] = result.failure->error;
    return json;
  }
  const FileReading& reading = *result.reading;
  json["vertices"] = reading.vertices;
  json["faces"] = reading.faces;
  json["units_with_marker"] = reading.units_with_marker;
  json["false_alarm_bound"] = reading.false_alarm;
  if (reading.mark) {
    const FoundMark& mark = *reading.mark;
    if (!mark.message.empty()) json["message_hex"] = to_hex(mark.message);
    if (mark.flux) {
      json["payload_bits"] = mark.flux->payload.bits;
      if (mark.flux->payload.content == FluxContent::Number) {
        json["number"] = to_hex(bytes_of(mark.flux->payload));
      }
      json["undone"] = mark.flux->undone;
    }
    json["scheme"] = mark.encoding.scheme;
    json["key"] = keys[mark.key].fingerprint();
    json["parts"] = mark.parts;
    json["units_agreeing"] = mark.agreeing;
    json["agreement"] = mark.agreement;
  }
  return json;
}

// The kinds of results in the tally.
enum Kind : std::size_t { kCarries, kCarriesNone, kFailedFirst };

std::vector<std::string_view> kinds_of_results() {
  std::vector<std::string_view> kinds = {"with a mark", "without a mark"};
  const auto statuses = file_status_names();
  kinds.insert(kinds.end(), statuses.begin(), statuses.end());
  return kinds;
}

void print_result(const ReadResult& result, std::span<const Key> keys, bool json) {
  if (!result.reading) std::cerr << "triglyph: " << printable(result.failure->error) << "\n";
  if (json) {
    std::cout << to_line(json_of(result, keys));
  } else if (result.reading) {
    print_text(result.path, *result.reading, keys);
  }
}

// Prints a result as it arrives, notes it and counts it.
void report_result(const ReadResult& result, std::span<const Key> keys, bool json,
                   const LoggedRun& run, RunTally& tally) {
  tally.clear_bar();
  print_result(result, keys, json);
  check_standard_output();  // nobody is there to read the rest
  run.note(result.path, status_of(result), json_of(result, keys));
  const std::size_t kind = !result.reading
                               ? kFailedFirst + static_cast<std::size_t>(result.failure->status)
                           : result.reading->mark ? kCarries
                                                  : kCarriesNone;
  tally.count(kind, !result.reading, false, result.path);
}

// Returns the distinct encodings of the marks in a file of records.
std::vector<Encoding> encodings_in(const std::filesystem::path& records) {
  std::vector<Encoding> encodings;
  const auto next = record_source(records);
  while (const std::optional<Record> record = next()) {
    if (!record->file.is_marked() || record->file.request.is_fill()) continue;
    Encoding encoding = record->file.encoding();
    if (std::find(encodings.begin(), encodings.end(), encoding) == encodings.end()) {
      encodings.push_back(std::move(encoding));
    }
  }
  return encodings;
}

// Returns the messages of the marks in a file of records.
KnownMessages messages_in_records(const std::filesystem::path& records) {
  KnownMessages messages;
  const auto next = record_source(records);
  while (const std::optional<Record> record = next()) {
    if (!record->file.request.is_fill()) messages.insert(record->file.request.message());
  }
  return messages;
}

int run_extract(const ExtractArguments& arguments) {
  const std::vector<Key> keys = arguments.keys.load();
  if (arguments.values.contains("scheme")) {
    check_contradictions(arguments.values, scheme_of(arguments.values));
  }
  std::vector<Encoding> encodings = encodings_of(arguments.values);
  KnownMessages known;
  if (!arguments.like.empty()) {
    known = messages_in_records(arguments.like);
    std::vector<Encoding> recorded = encodings_in(arguments.like);
    for (Encoding& encoding : encodings) {
      if (std::find(recorded.begin(), recorded.end(), encoding) == recorded.end()) {
        recorded.push_back(std::move(encoding));
      }
    }
    encodings = std::move(recorded);
  }
  const std::vector<std::filesystem::path> files = gather_files(arguments.inputs, std::cin);
  return arguments.run.supervised({"extract", kinds_of_results()}, [&](const WorkOrder& order) {
    std::optional<Ledger> ledger;
    if (!arguments.run.ledger().empty()) ledger.emplace(arguments.run.ledger());
    if (ledger) known.merge(messages_in(*ledger));
    const LoggedRun run(ledger ? &*ledger : nullptr, order, "extract");
    RunTally tally(arguments.run, order, files, kinds_of_results());
    read_files(
        files, encodings, keys, arguments.run.context(order),
        [&](ReadResult result) {
          if (result.reading) resolve_number(known, keys, *result.reading);
          report_result(result, keys, arguments.json, run, tally);
        },
        order.board->stop());
    if (order.only) return kDone;
    int code = tally.finish("file", "files");
    if (code == kDone && tally.counted(kCarriesNone) > 0) code = kNoMark;
    run.end(code);
    return code;
  });
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
  arguments->run.add_to(*verb);
  verb->footer(
      "Look for a mark in every mesh below a directory, under two keys:\n"
      "  triglyph extract found/ --key-file owner.key --key-file former.key");
  verb->callback(
      [&action, arguments] { action = [arguments] { return run_extract(*arguments); }; });
}

}  // namespace triglyph
