#include <cmath>
#include <iostream>
#include <memory>

#include "cli/app.h"
#include "cli/options.h"
#include "cli/verbs.h"
#include "engine/base/error.h"
#include "engine/base/parallel.h"
#include "manifests/pipeline.h"
#include "manifests/run.h"

namespace triglyph {
namespace {

struct ExtractArguments {
  std::vector<std::filesystem::path> meshes;
  bool json = false;
  SchemeArguments scheme;
  KeyArgument key;
  MachineArguments machine;
};

// Printable text as it is, anything else in hexadecimal.
std::string shown(const Message& message) {
  const bool printable = std::all_of(message.begin(), message.end(),
                                     [](std::uint8_t byte) { return byte >= 32 && byte < 127; });
  return printable ? "\"" + std::string(message.begin(), message.end()) + "\""
                   : "0x" + to_hex(message);
}

void print_text(const std::filesystem::path& path, const Extraction& found) {
  std::cout << path.string() << ": ";
  if (!found.message) {
    std::cout << "no mark\n";
    return;
  }
  std::cout << shown(*found.message) << "  " << found.agreeing << " units agree, " << found.parts
            << " parts, false alarm 2^" << std::ilogb(found.false_alarm) << "\n";
}

void print_json(const std::filesystem::path& path, const FileExtraction& file) {
  const Extraction& found = file.extraction;
  nlohmann::ordered_json json = {{"mesh", path.string()},
                                 {"status", found.message ? "marked" : "no mark"},
                                 {"vertices", file.vertices},
                                 {"faces", file.faces},
                                 {"units_with_marker", found.readings.size()}};
  if (found.message) {
    json["message_hex"] = to_hex(*found.message);
    json["parts"] = found.parts;
    json["units_agreeing"] = found.agreeing;
    json["agreement"] = found.agreement;
    json["false_alarm_bound"] = found.false_alarm;
  }
  std::cout << to_line(json);
}

int run_extract(const ExtractArguments& arguments) {
  const Key key = arguments.key.load();
  JobSettings settings;
  arguments.scheme.apply_to(settings);
  bool all_marked = true;
  with_threads(arguments.machine.threads(), [&] {
    for (const std::filesystem::path& path : arguments.meshes) {
      try {
        const FileExtraction file = extract_file(path, key, settings.resolved());
        all_marked = all_marked && file.extraction.message.has_value();
        arguments.json ? print_json(path, file) : print_text(path, file.extraction);
      } catch (const Error& error) {
        all_marked = false;
        std::cerr << "triglyph: " << error.what() << "\n";
        if (arguments.json) {
          const nlohmann::ordered_json json = {
              {"mesh", path.string()}, {"status", name_of(error.code())}, {"error", error.what()}};
          std::cout << to_line(json);
        }
      }
    }
  });
  return all_marked ? kDone : kSomeFailed;
}

}  // namespace

void add_extract_verb(CLI::App& app, Action& action) {
  CLI::App* verb = app.add_subcommand("extract", "Read the message from meshes, blind");
  auto arguments = std::make_shared<ExtractArguments>();
  verb->add_option("meshes", arguments->meshes, "Meshes to read")->required()->type_name("MESH...");
  verb->add_flag("--json", arguments->json, "One JSON object a mesh");
  arguments->scheme.add_to(*verb);
  arguments->key.add_to(*verb);
  arguments->machine.add_threads_to(*verb);
  verb->callback(
      [&action, arguments] { action = [arguments] { return run_extract(*arguments); }; });
}

}  // namespace triglyph
