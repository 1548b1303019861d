// A whole collection: jobs marked and files read many at a time, bounded by memory, with the
// results in order.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "engine/marking/read_file.h"
#include "engine/marking/verify_file.h"
#include "manifests/flow.h"
#include "manifests/manifest.h"
#include "manifests/record.h"

namespace triglyph {

// Marks every job. `on_record` is called in job order, one call at a time. When `stop` becomes true
// no further job is started, meshes in work end as Interrupted unless they are already being
// written out, and no half-written file is left. Never throws for what a mesh holds; Error
// Malformed if the manifest breaks off.
void run_jobs(JobSource& jobs, const Key& key, const FlowOptions& options,
              const std::function<void(const Record&)>& on_record, const std::atomic<bool>& stop);

// What came of reading one file: a reading, or why there is none.
struct ReadResult {
  std::filesystem::path path;
  std::optional<FileReading> reading;
  std::optional<FileStatus> status;  // of a file that could not be read
  std::string error;                 // one line naming file and place
};

// Reads every file under every encoding and key; see read_file(). Results come in order.
void read_files(std::span<const std::filesystem::path> files, std::span<const Encoding> encodings,
                std::span<const Key> keys, const FlowOptions& options,
                const std::function<void(const ReadResult&)>& on_result,
                const std::atomic<bool>& stop);

// Returns the next record of a run, or nothing at the end.
using RecordSource = std::function<std::optional<Record>()>;

// Verifies the file of every record; see verify_file(). Verdicts come in the order of the records.
// What the source throws is rethrown after the verdicts before it.
void verify_files(const RecordSource& records, const Key& key, bool locate,
                  const FlowOptions& options,
                  const std::function<void(const Record&, const Verification&)>& on_verdict,
                  const std::atomic<bool>& stop);

}  // namespace triglyph
