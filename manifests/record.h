// What is written down about one mesh: one JSON object a line, keys in a fixed order. Everything
// but the "run" object depends on the inputs alone, so the records of two runs can be compared
// without it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "manifests/job.h"

namespace triglyph {

inline constexpr int kRecordSchema = 1;

enum class Status {
  Marked,       // the output is there and its mark was read back from it
  TooSmall,     // fewer units than the message has parts; no output
  TooCoarse,    // the file's numbers cannot hold the mark; no output
  NotVerified,  // the mark could not be read back; no output
  Unreadable,   // the rest: see ErrorCode
  Malformed,
  Unsupported,
  Unwritable,
  Usage,
  Failed,  // an error of the program itself
  Interrupted,
};

// "marked", "too small", "positions too coarse", ...
[[nodiscard]] std::string_view name_of(Status status);

struct StageTimes {
  double load = 0, mark = 0, write = 0, read_back = 0, measure = 0;  // seconds
  double layout = 0, assign = 0;                                     // of mark: steps 1 and 2
};

struct Record {
  Job job;
  MarkOptions options;  // as they applied
  Status status = Status::Failed;
  std::string error;  // one line naming file and place; empty if marked
  std::string file_format;
  std::uint64_t vertices = 0;  // coordinate triples of the file
  std::uint64_t points = 0;    // distinct ones
  std::uint64_t faces = 0;
  WordFormat format;  // of the words; fill chooses the subscript bits
  std::uint32_t parts = 0;
  std::uint32_t candidates = 0;
  std::uint32_t units_valid = 0;
  std::uint32_t units_bound = 0;
  std::uint32_t units_assigned = 0;
  std::uint32_t units_embedded = 0;  // returned all bits when the output was read back
  double cost_max = 0;               // model units
  double cost_sum = 0;
  double hausdorff = 0;           // symmetric, model units
  double hausdorff_rel_diag = 0;  // share of the bounding box's diagonal
  double displacement_max = 0;    // model units
  double displacement_rms = 0;
  std::vector<Carrier> units;  // that were embedded, if detail is wanted; ascending by anchor
  std::string input_hash;
  std::string output_hash;
  std::string key_fingerprint;
  std::uint64_t memory_estimate = 0;  // bytes the run set aside for the mesh
  StageTimes times;
};

// `peak_bytes`: largest resident size of the process so far.
[[nodiscard]] nlohmann::ordered_json to_json(const Record& record, std::uint64_t peak_bytes);

// One line of JSON, ended by a newline; bytes that are no UTF-8 (in file names) are replaced.
[[nodiscard]] std::string to_line(const nlohmann::ordered_json& json);

// Settings and identity of a finished mesh, as verify needs them.
struct RecordedMark {
  std::filesystem::path out;
  Status status = Status::Failed;
  Message message;
  bool fill = false;
  MarkOptions options;
  std::uint32_t parts = 0;
  std::uint32_t units_embedded = 0;
  std::uint64_t points = 0;
  std::uint64_t faces = 0;
  std::optional<std::vector<Carrier>> units;  // nothing: not written down
  std::string output_hash;
  std::string key_fingerprint;
};

// Throws Error Malformed (without a path) if the line is no record of this schema.
[[nodiscard]] RecordedMark parse_record(const std::string& line);

}  // namespace triglyph
