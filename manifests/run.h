// Runs over whole collections: many files are marked, read or verified in parallel, within a memory
// budget, and results come in order.
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
#include "manifests/resume.h"
#include "manifests/supervisor.h"

namespace triglyph {

// What surrounds a run.
struct RunContext {
  FlowOptions flow = {};
  const Resume* resume = nullptr;    // null: everything is done, and nothing remembered
  const WorkOrder* order = nullptr;  // null: the run is not supervised
};

// What a run tells as it goes, one call at a time.
struct RunEvents {
  // A job is done: its output is there, or will never be. In the order in which jobs are done.
  std::function<void(const Record&)> completed = {};
  // The same in the order of the jobs.
  std::function<void(const Record&)> delivered = {};
};

// Marks every job that is not done already; see Resume. When `stop` becomes true, no further job is
// started, meshes in process end as Interrupted unless their output is being published, and no
// incomplete file is left. An error of a mesh goes into its record, as does what killed an earlier
// worker. Throws Error Malformed if a line of the manifest is invalid.
void run_jobs(JobSource& jobs, const Key& key, const RunContext& context, const RunEvents& events,
              const std::atomic<bool>& stop);

// Says what run_jobs() would do with every job, in their order, and does nothing. Throws as it
// does.
void plan_jobs(JobSource& jobs, const Resume& resume,
               const std::function<void(const Job&, const Decision&)>& on_decision,
               const std::atomic<bool>& stop);

// The result of reading one file: a reading, or the reason why there is none.
struct ReadResult {
  std::filesystem::path path;
  std::optional<FileReading> reading;
  std::optional<FileStatus> status;  // of a file that could not be read
  std::string error;                 // one line naming file and place
};

// Reads every file under every encoding and key; see read_file(). Calls `on_result` in the order of
// the files, one call at a time.
void read_files(std::span<const std::filesystem::path> files, std::span<const Encoding> encodings,
                std::span<const Key> keys, const RunContext& context,
                const std::function<void(const ReadResult&)>& on_result,
                const std::atomic<bool>& stop);

// Returns the next record of a run, or nothing at the end.
using RecordSource = std::function<std::optional<Record>()>;

// Verifies the file of every record; see verify_file(). Calls `on_verdict` in the order of the
// records, one call at a time. An exception of the source is rethrown after the verdicts before it.
void verify_files(const RecordSource& records, const Key& key, bool locate,
                  const RunContext& context,
                  const std::function<void(const Record&, const Verification&)>& on_verdict,
                  const std::atomic<bool>& stop);

}  // namespace triglyph
