// Sweeps: a library that was marked is looked through again and again, and each time it is said
// what changed. A file whose bytes are still those that an earlier sweep read its mark from is not
// read again.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "engine/message/key.h"
#include "manifests/ledger.h"
#include "manifests/run_context.h"
#include "manifests/shard.h"

namespace triglyph {

// How an output is.
enum class FileState : std::uint8_t {
  Intact,       // the bytes are those that were written
  Altered,      // the bytes differ, and the whole mark is there
  MarkDamaged,  // the message can be read, but units or a layer of the mark are gone
  MarkLost,     // the mesh can be read, but not its mark
  Damaged,      // the bytes differ, and are no mesh any more
  Moved,        // not there, but a file with its bytes is elsewhere
  Missing,      // not there, and nowhere below the folders that were searched
  WrongKey,     // the bytes differ, and none of the keys is the one that it was marked under
  Unreadable,   // it is there, but cannot be read, or the work on it failed
};
[[nodiscard]] std::string_view name_of(FileState state);
[[nodiscard]] std::optional<FileState> file_state(std::string_view name);
[[nodiscard]] std::vector<std::string_view> file_state_names();  // in the order of FileState

// A file of a sweep.
struct SweptFile {
  std::string target;  // as in the ledger
  FileState state = FileState::Intact;
  FileState before = FileState::Intact;  // at the last sweep, or as the run left it
  // The state, or the content of a file that is not intact, is another than before.
  bool is_new = false;
  bool is_accepted = false;  // by the owner, and the same since
  bool is_kept = false;      // an earlier process of this sweep found it
  std::string line;          // JSON object; see json_of() in the implementation

  // Returns "unchanged", "restored", or the name of the new state.
  [[nodiscard]] std::string_view change() const;
  // Returns whether somebody has to look at it: it is not as it was marked and not accepted, or it
  // is new.
  [[nodiscard]] bool is_news() const;
};

// Which outputs of a ledger a sweep looks at: those that have all of the properties.
struct SweepSelection {
  std::vector<std::string> below = {};  // canonical names of files or folders; empty: all
  // One of several nearly equal parts, by a hash of the name, so that each file stays in its part.
  Shard part = {};
  double sample = 1;              // share of the files, others in each sweep
  std::string marked_since = {};  // UTC, as the ledger writes times; empty: ever
};

struct SweepOptions {
  SweepSelection selection = {};
  bool reads_all = false;                          // also what is known by its bytes
  bool accepts = false;                            // what is found is accepted
  std::vector<std::filesystem::path> search = {};  // more folders to look for missing files in
  // When to start no further file.
  std::optional<std::chrono::steady_clock::time_point> deadline = {};
};

struct SweepEnd {
  std::uint64_t outputs = 0;    // of the selection, that were looked at
  bool is_out_of_time = false;  // the deadline came before the end
};

// Looks at every selected output of the ledger, in the order of their names, and enters what it
// finds as states of the run, whose number must be `run`. States of this run that are there
// already are delivered without a look. Calls `on_file` in order, one call at a time. Throws Error
// Usage if the ledger has no output below one of the names. O(files) hashing, and reading where the
// bytes differ from those that were last seen.
SweepEnd sweep(Ledger& ledger, std::int64_t run, std::span<const Key> keys,
               const SweepOptions& options, const RunContext& context,
               const std::function<void(const SweptFile&)>& on_file, const std::atomic<bool>& stop);

// Returns the sweep to go on with: the last run of the ledger that is a sweep, if it had the same
// command in the same directory and did not come to its end.
[[nodiscard]] std::optional<std::int64_t> unfinished_sweep(const Ledger& ledger,
                                                           const std::string& command,
                                                           const std::string& directory);

// How a sweep ends that ran out of its time.
inline constexpr std::string_view kOutOfTime = "out of time";

}  // namespace triglyph
