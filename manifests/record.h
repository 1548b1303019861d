// What is written down about one mesh: one JSON object a line, keys in a fixed order. Everything
// but the "run" object depends on the inputs alone, so the records of two runs can be compared
// without it.
#pragma once

#include <cstdint>
#include <string>

#include <nlohmann/json.hpp>

#include "engine/marking/mark_file.h"

namespace triglyph {

// Schema 2 writes options under the names and in the units of manifests; schema 1 wrote some as
// shares. Both are read.
inline constexpr int kRecordSchema = 2;

struct Record {
  MarkedFile file;
  std::size_t index = 0;              // place in the run, from 0; not written
  std::uint64_t memory_estimate = 0;  // bytes the run set aside for the mesh
  std::uint64_t peak_bytes = 0;       // largest resident size of the process so far
};

[[nodiscard]] nlohmann::ordered_json to_json(const Record& record);

// The inverse of to_json(), also for records of schema 1, of which only what reading and verifying
// need comes back. Throws Error Malformed without a path if the line is no record.
[[nodiscard]] Record parse_record(const std::string& line);

}  // namespace triglyph
