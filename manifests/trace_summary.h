// What a trace adds up to.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

namespace triglyph {

struct StageTotal {
  std::uint64_t count = 0;  // spans
  double seconds = 0;       // of all threads together
};

// Returns the spans of a trace by name: "file" encloses the stages of a file, the others exclude
// each other. Also reads a trace whose end is missing. Throws
// Error Unreadable or Malformed. O(events).
[[nodiscard]] std::map<std::string, StageTotal> summarise_trace(const std::filesystem::path& path);

}  // namespace triglyph
