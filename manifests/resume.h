// What a run need not do again: the ledger tells which outputs are there already, made from the
// same mesh with the same request and key.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "engine/message/key.h"
#include "manifests/job.h"
#include "manifests/ledger.h"
#include "manifests/record.h"

namespace triglyph {

struct ResumeOptions {
  bool force = false;       // does everything again
  bool no_clobber = false;  // keeps existing files that this ledger knows nothing of
};

// What is to be done with a job.
struct Decision {
  enum class Kind { Mark, Keep, Refuse };
  Kind kind = Kind::Mark;
  std::string reason;                      // in one line: why it is marked again or refused
  FileStatus status = FileStatus::Marked;  // of Refuse
  std::optional<Record> record = {};       // of Keep: the result as it was recorded
  bool is_of_this_run = false;             // of Keep: an earlier worker of this run did it

  [[nodiscard]] static Decision mark(std::string reason = {}) {
    return {Kind::Mark, std::move(reason)};
  }
  [[nodiscard]] static Decision refuse(FileStatus status, std::string reason) {
    return {Kind::Refuse, std::move(reason), status};
  }
};

// A run's view of its ledger. Its members may be called from any thread.
class Resume {
 public:
  // The ledger must outlive the object. `run` is the number of the run in it.
  // `base` is the ledger of the whole, where this run has one for its shard; null: none.
  Resume(Ledger& ledger, std::int64_t run, const Key& key, const ResumeOptions& options,
         const Ledger* base = nullptr);

  // Decides from the ledger and the files. Hashes input and output if the ledger knows a result
  // for the same request. Throws Error Unwritable if the ledger cannot be read.
  [[nodiscard]] Decision decide(const Job& job) const;

  // Returns why the mesh with this content must not be marked again: it is an output that the
  // ledger issued under this key, whatever the scheme. Nothing: it may be marked.
  [[nodiscard]] std::optional<std::string> issued_before(const std::string& input_hash) const;

  // Enters the result; a mark must be entered before its output gets its name, so that no file is
  // there that the ledger does not know. Throws Error Unwritable.
  void enter(const Record& record) const;

  // Enters the shape of a mesh that copies were made of, unless there is one. Throws as enter().
  void keep_shape(const FileMarking& marking) const;

  // Says that this run found the job done.
  void keep(const Job& job) const;

 private:
  Ledger& ledger_;
  const Ledger* base_;
  std::int64_t run_;
  std::string key_;  // fingerprint
  ResumeOptions options_;
};

// Enters a result into the ledger, as of this run.
void enter_record(Ledger& ledger, std::int64_t run, const Record& record);

// Returns the hash of a request: equal for equal payload, scheme and options. O(options).
[[nodiscard]] std::string task_hash(const MarkRequest& request);

// Returns the absolute name of a file with the symbolic links of its folder resolved. The file need
// not exist. A thread looks a folder up once while it asks for names in it.
[[nodiscard]] std::string canonical_name(const std::filesystem::path& path);

}  // namespace triglyph
