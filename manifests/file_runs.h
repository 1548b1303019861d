// Runs that change no file: many files are read, verified, compared or attacked in parallel, within
// a memory budget, and results come in order.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "engine/attack/attack_file.h"
#include "engine/marking/read_file.h"
#include "engine/marking/trace_file.h"
#include "engine/marking/verify_file.h"
#include "manifests/pairs.h"
#include "manifests/record.h"
#include "manifests/run_context.h"

namespace triglyph {

// Why a file has no result.
struct FileFailure {
  FileStatus status = FileStatus::Failed;
  std::string error;  // one line naming file and place
};

// A file to work on. Derived classes hold the result.
struct FileItem : FlowItem {
  std::filesystem::path file;
  std::optional<FileFailure> failure = {};
  bool is_done = false;  // not set by the work

  [[nodiscard]] std::string_view name() const override { return file.native(); }
};

// Runs `work`, which a trace calls `stage`, for every item that the source returns before null, in
// parallel, and `deliver` in their order, one call at a time. An exception of `work` becomes the
// failure of its item, as does the death of an earlier worker; one of the source or of `deliver`
// ends the run and is rethrown.
void run_file_items(std::string_view stage,
                    const std::function<std::unique_ptr<FileItem>()>& source,
                    const std::function<void(FileItem&)>& work,
                    const std::function<void(FileItem&)>& deliver, const RunContext& context,
                    const std::atomic<bool>& stop);

// The result of reading one file: a reading or a failure.
struct ReadResult {
  std::filesystem::path path;
  std::optional<FileReading> reading;
  std::optional<FileFailure> failure;
};

// Reads every file under every encoding and key; see read_file(). Calls `on_result` in the order of
// the files, one call at a time. An exception of `on_result` ends the run and is rethrown.
void read_files(std::span<const std::filesystem::path> files, std::span<const Encoding> encodings,
                std::span<const Key> keys, const RunContext& context,
                const std::function<void(const ReadResult&)>& on_result,
                const std::atomic<bool>& stop);

// The result of tracing one file: a trace or a failure.
struct TraceResult {
  std::filesystem::path path;
  std::optional<FileTrace> trace;
  std::optional<FileReading> reading;  // of messages, if that was asked for
  std::optional<FileFailure> failure;
};

// Traces every file; see trace_file(). Where it names nobody, the file is also read under the
// encodings, if there are any; see read_file(). Calls `on_result` in the order of the files, one
// call at a time.
void trace_files(std::span<const std::filesystem::path> files, std::span<const Suspects> suspects,
                 const TraceOptions& options, std::span<const Encoding> encodings,
                 const RunContext& context,
                 const std::function<void(const TraceResult&)>& on_result,
                 const std::atomic<bool>& stop);

// A mesh to attack, and the file to write; or copies of a mesh to combine and attack.
struct AttackJob {
  std::filesystem::path mesh;
  std::filesystem::path out;
  Attack attack;
  std::vector<std::filesystem::path> more_copies;  // of the mesh; with a collusion only
  std::optional<Collusion> collusion;              // what combines the mesh with them
};

// The result of attacking one mesh: what was written or a failure.
struct AttackResult {
  AttackJob job;
  std::optional<AttackedFile> attacked;
  std::optional<FileFailure> failure;
};

// Attacks every mesh; see attack_file() and collude_files(). Calls `on_result` in the order of the
// jobs, one call at a time.
void attack_files(std::span<const AttackJob> jobs, std::uint64_t seed, const RunContext& context,
                  const std::function<void(const AttackResult&)>& on_result,
                  const std::atomic<bool>& stop);

// Returns the next record of a run, or nothing at the end.
using RecordSource = std::function<std::optional<Record>()>;

// Verifies the file of every record; see verify_file(). Calls `on_verdict` in the order of the
// records, one call at a time. An exception of the source is rethrown after the verdicts before it.
void verify_files(const RecordSource& records, const Key& key, bool locate,
                  const RunContext& context,
                  const std::function<void(const Record&, const Verification&)>& on_verdict,
                  const std::atomic<bool>& stop);

// The result of the work on a pair of meshes: values, of which there may be none, or a failure.
struct PairResult {
  MeshPair pair;
  nlohmann::ordered_json values;
  std::optional<FileFailure> failure;
};

// Calls `work` for every pair, in parallel, with a result that it completes, and `on_result` in the
// order of the pairs, one call at a time. An exception of `work` becomes the failure of its pair.
void run_pairs(const PairSource& pairs, const std::function<void(PairResult&)>& work,
               const RunContext& context, const std::function<void(const PairResult&)>& on_result,
               const std::atomic<bool>& stop);

}  // namespace triglyph
