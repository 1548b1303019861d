#include "manifests/trace_summary.h"

#include <fstream>

#include <nlohmann/json.hpp>

#include "engine/base/error.h"

namespace triglyph {

std::map<std::string, StageTotal> summarise_trace(const std::filesystem::path& path) {
  std::ifstream lines(path, std::ios::binary);
  if (!lines) throw Error(ErrorCode::Unreadable, path, "", "cannot be opened");
  std::map<std::string, StageTotal> totals;
  std::string line;
  for (std::size_t number = 1; std::getline(lines, line); ++number) {
    if (line == "[" || line == "]") continue;
    if (!line.empty() && line.back() == ',') line.pop_back();
    const auto event = nlohmann::json::parse(line, nullptr, false);
    if (event.is_discarded() && lines.peek() == std::ifstream::traits_type::eof()) break;
    if (!event.is_object()) {
      throw Error(ErrorCode::Malformed, path, "line " + std::to_string(number), "is no event");
    }
    if (event.value("ph", "") != "X") continue;
    StageTotal& total = totals[event.value("name", "")];
    ++total.count;
    total.seconds += event.value("dur", 0.0) / 1e6;
  }
  return totals;
}

}  // namespace triglyph
