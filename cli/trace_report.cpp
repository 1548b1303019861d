#include "cli/trace_report.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <string>
#include <vector>

#include "engine/base/output_file.h"
#include "engine/base/text.h"
#include "engine/io/file_bytes.h"
#include "manifests/json_line.h"

namespace triglyph {
namespace {

namespace fs = std::filesystem;

std::string text_of(FingerprintLayer layer) {
  switch (layer) {
    case FingerprintLayer::Units:
      return "units";
    case FingerprintLayer::Flux:
      return "flux";
    case FingerprintLayer::Points:
      return "points";
  }
  return "";
}

std::string bound_of(double log2) {
  return "2^" + std::to_string(std::lround(std::ceil(log2)));
}

constexpr std::string_view kHowItIsCounted =
    "## How this is counted\n\n"
    "Every copy carries bits, or phases, that are a secret random function of the key and of the "
    "recipient's name alone (BLAKE2b). For each place that was read, the score of a name is the "
    "likelihood of what was read if the place carries the name's value, divided by the mean of "
    "this likelihood over all values, weighted as names have them. The likelihood of a name is "
    "the product over all places, and its evidence the binary logarithm of that. Over names drawn "
    "at random the mean likelihood is 1, whatever the file and whatever was done to it, because "
    "only the bits of the name are random. By Markov's inequality a name that has nothing to do "
    "with the file reaches an evidence of e bits with a probability of 2^-e at most.\n\n"
    "Everything that was tried is weighed by priors that add up to 1 (ways to read a layer, what "
    "may have been done to the mesh, originals), and the bound is multiplied by the number of "
    "names, keys and files, and by 2 rounds of reading.\n";

}  // namespace

bool TraceReport::names_one(const TraceResult& result) const {
  const bool by_fingerprint = result.trace && !result.trace->names.empty() &&
                              subject_.options.believes(result.trace->names[0]);
  return by_fingerprint || (result.reading && result.reading->mark);
}

std::string_view TraceReport::status_of(const TraceResult& result) const {
  if (result.failure) return name_of(result.failure->status);
  return names_one(result) ? "traced" : "nobody";
}

void TraceReport::print(const TraceResult& result, bool json) const {
  if (result.failure) std::cerr << "triglyph: " << printable(result.failure->error) << "\n";
  if (json) {
    std::cout << to_line(json_of(result));
  } else if (!result.failure) {
    print_text(result);
  }
}

nlohmann::ordered_json TraceReport::json_of(const TraceResult& result) const {
  nlohmann::ordered_json json;
  put_path(json, "mesh", result.path);
  json["status"] = status_of(result);
  if (result.failure) {
    json["error"] = result.failure->error;
    return json;
  }
  json["vertices"] = result.trace->vertices;
  json["faces"] = result.trace->faces;
  json["candidates"] = subject_.names;
  json["names"] = nlohmann::ordered_json::array();
  for (const Traced& traced : shown_names(result)) json["names"].push_back(json_of(traced));
  if (result.reading && result.reading->mark) {
    json["message_hex"] = to_hex(result.reading->mark->message);
    json["false_alarm_bound"] = result.reading->false_alarm;
  }
  return json;
}

std::span<const Traced> TraceReport::shown_names(const TraceResult& result) const {
  const std::span<const Traced> all = result.trace->names;
  return all.first(std::min(all.size(), subject_.most));
}

nlohmann::ordered_json TraceReport::json_of(const Traced& traced) const {
  nlohmann::ordered_json json;
  put_path(json, "name", std::string(traced.name.begin(), traced.name.end()));
  json["is_believed"] = subject_.options.believes(traced);
  json["evidence_bits"] = traced.evidence.bits;
  json["false_alarm_log2"] = traced.false_alarm_log2;
  json["key"] = subject_.keys[traced.key].fingerprint();
  for (const LayerEvidence& layer : traced.evidence.layers) {
    json["layers"].push_back(
        {{"layer", text_of(layer.layer)}, {"bits", layer.bits}, {"read_as", layer.what}});
  }
  if (!subject_.options.believes(traced)) return json;
  for_each_mark(traced.name, [&](const LedgerMark& mark) {
    nlohmann::ordered_json issued = {{"mark", mark.number}};
    put_path(issued, "mesh", mark.mesh);
    put_path(issued, "out", mark.out);
    issued["issued"] = mark.issued;
    json["marks"].push_back(std::move(issued));
  });
  return json;
}

void TraceReport::print_text(const TraceResult& result) const {
  std::cout << printable(result.path.string()) << ": ";
  if (!names_one(result)) {
    std::cout << "nobody of " << subject_.names << (subject_.names == 1 ? " name" : " names");
    if (!result.trace->names.empty()) {
      const Traced& best = result.trace->names[0];
      std::cout << "; the best is " << shown(best.name) << ", false alarm "
                << bound_of(best.false_alarm_log2);
    }
    std::cout << "\n";
    return;
  }
  const char* separator = "";
  for (const Traced& traced : shown_names(result)) {
    if (!subject_.options.believes(traced)) break;
    std::cout << separator << shown(traced.name) << "  false alarm "
              << bound_of(traced.false_alarm_log2) << " (";
    const char* comma = "";
    for (const LayerEvidence& layer : traced.evidence.layers) {
      std::cout << comma << text_of(layer.layer) << " " << std::lround(layer.bits);
      comma = ", ";
    }
    std::cout << " bits)";
    print_marks(traced.name);
    separator = "\n  and ";
  }
  if (result.reading && result.reading->mark) {
    std::cout << "the message " << shown(result.reading->mark->message) << "  "
              << result.reading->mark->encoding.scheme;
    print_marks(result.reading->mark->message);
  }
  std::cout << "\n";
}

// Prints the last few copies that were issued for a name.
void TraceReport::print_marks(const Message& name) const {
  constexpr std::size_t kShown = 3;
  std::vector<LedgerMark> marks;
  std::size_t count = 0;
  for_each_mark(name, [&](const LedgerMark& mark) {
    ++count;
    marks.push_back(mark);
    if (marks.size() > kShown) marks.erase(marks.begin());
  });
  for (const LedgerMark& mark : marks) {
    std::cout << "\n    issued " << mark.issued << " as " << printable(mark.out);
  }
  if (count > marks.size()) std::cout << "\n    and " << count - marks.size() << " more";
}

void TraceReport::for_each_mark(const Message& name,
                                const std::function<void(const LedgerMark&)>& visit) const {
  if (subject_.ledger != nullptr) subject_.ledger->for_each_mark_of(to_hex(name), visit);
}

std::optional<fs::path> TraceReport::original_of(const TraceResult& result) const {
  std::optional<fs::path> original;
  if (result.trace->names.empty()) return original;
  for_each_mark(result.trace->names[0].name, [&](const LedgerMark& mark) {
    std::error_code ignored;
    if (!original && fs::exists(mark.mesh, ignored)) original = mark.mesh;
  });
  return original;
}

void TraceReport::write_name(const Traced& traced, std::string_view hash, std::string& text) const {
  const auto add = [&](const std::string& line) { text += line + "\n"; };
  add("\n## " + printable(std::string(traced.name.begin(), traced.name.end())) + "\n");
  add("- evidence: " + std::to_string(std::lround(traced.evidence.bits)) +
      " bits; false alarm, all told: " + bound_of(traced.false_alarm_log2));
  add("- key: fingerprint " + subject_.keys[traced.key].fingerprint() + "\n");
  add("| layer | evidence, bits | read as |\n|---|---|---|");
  for (const LayerEvidence& layer : traced.evidence.layers) {
    add("| " + text_of(layer.layer) + " | " + std::to_string(std::lround(layer.bits)) + " | " +
        layer.what + " |");
  }
  bool has_heading = false;
  for_each_mark(traced.name, [&](const LedgerMark& mark) {
    if (!has_heading) {
      add("\nCopies that the ledger issued for this name:\n");
      add("| mark | issued | file | its hash | made of | its hash |\n|---|---|---|---|---|---|");
    }
    has_heading = true;
    const bool is_this = mark.output_hash == hash;
    add("| " + std::to_string(mark.number) + " | " + mark.issued + " | " + printable(mark.out) +
        (is_this ? " (the very bytes)" : "") + " | " + mark.output_hash + " | " +
        printable(mark.mesh) + " | " + mark.input_hash + " |");
  });
}

void TraceReport::write(const TraceResult& result, const fs::path& file) const {
  const FileBytes bytes = FileBytes::open(result.path);
  const std::string hash = content_hash(bytes.bytes());
  std::string text = "# Whose copy " + printable(result.path.string()) + " is\n\n";
  text += "- file: " + std::to_string(bytes.bytes().size()) + " bytes, BLAKE2b-256 " + hash + "\n";
  text += "- mesh: " + std::to_string(result.trace->vertices) + " vertices, " +
          std::to_string(result.trace->faces) + " faces\n";
  text += "- looked for: " + std::to_string(subject_.names) + " names under " +
          std::to_string(subject_.keys.size()) + " keys, in " +
          std::to_string(std::lround(subject_.options.files)) + " files\n";
  text += "- believed below a false alarm of " + to_text(subject_.options.false_alarm) + "\n";
  text += "- read by triglyph " TRIGLYPH_VERSION "\n";
  for (const Traced& traced : result.trace->names) {
    if (subject_.options.believes(traced)) write_name(traced, hash, text);
  }
  if (result.reading && result.reading->mark) {
    text += "\n## The message " + shown(result.reading->mark->message) + "\n\n- read blind with " +
            result.reading->mark->encoding.scheme + "; false alarm at most " +
            to_text(result.reading->false_alarm) + "\n";
  }
  text += "\n" + std::string(kHowItIsCounted);
  OutputFile output(file);
  output.write(text);
  output.commit();
}

}  // namespace triglyph
