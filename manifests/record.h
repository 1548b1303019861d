// Records: one JSON object per mesh and line, with keys in a fixed order. Everything but the object
// "run" depends on the inputs alone, so the records of two runs can be compared without it. A name
// that is not UTF-8 is also there byte for byte, in hexadecimal: "mesh_bytes", "out_bytes".
#pragma once

#include <cstdint>
#include <string>

#include <nlohmann/json.hpp>

#include "engine/marking/mark_file.h"

namespace triglyph {

// Schema 2 has options with the names and units of manifests, where schema 1 had shares for some.
// Both are read.
inline constexpr int kRecordSchema = 2;

struct Record {
  MarkedFile file;
  std::size_t index = 0;              // place in the run, from 0
  std::string shard = {};             // "3/7", if the run was one
  std::uint64_t jobs = 0;             // of the whole run, if this was a shard
  std::uint64_t memory_estimate = 0;  // bytes that the run reserved for the mesh
  std::uint64_t peak_bytes = 0;       // peak resident size of the process so far
  std::string directory = {};         // where the run stood, to which relative names refer
  std::string task = {};              // see task_hash(); not written
  bool is_kept = false;               // an earlier run did it; not written
  std::string line = {};              // to_line(to_json()) of it, if that was needed before
};

// Returns the record as a line of JSON with its newline: Record::line, or else a new one.
[[nodiscard]] std::string line_of(const Record& record);

// Returns the record as JSON of the current schema.
[[nodiscard]] nlohmann::ordered_json to_json(const Record& record);

// Parses a record, the inverse of to_json(). Also accepts schema 1, from which it takes only what
// extraction and verification need. Throws Error Malformed without a path if the line is no record.
[[nodiscard]] Record parse_record(const std::string& line);

}  // namespace triglyph
