// How far a run is, as its board tells.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "manifests/supervisor.h"

namespace triglyph {

// Places among RunBoard::counters; the kinds of results come before.
inline constexpr std::size_t kMostKinds = 24;
enum RunCounter : std::size_t {
  kRunId = kMostKinds,
  kStarted,    // when the first worker began with the files; see milliseconds_now()
  kFailed,     // files
  kKept,       // files that an earlier run did
  kBytes,      // of all files that are done
  kKeptBytes,  // of those that an earlier run did
};

struct Progress {
  std::uint64_t files_done = 0;
  std::uint64_t files_total = 0;  // 0: not known
  std::uint64_t failed = 0;
  std::uint64_t kept = 0;           // as an earlier run left them
  std::uint64_t bytes_done = 0;     // of input files
  std::uint64_t bytes_kept = 0;     // of those that were kept
  std::uint64_t bytes_total = 0;    // 0: not known
  double seconds = 0;               // since the first file
  std::vector<ItemInWork> in_work;  // the one that has taken longest first

  // Returns how many bytes are worked through in a second; those that were kept took no work.
  [[nodiscard]] double bytes_a_second() const;
  // Returns the share that is done, of the bytes, or else of the files; nothing: not known.
  [[nodiscard]] std::optional<double> share() const;
  // Returns how long the rest will take at the present rate; nothing: not known.
  [[nodiscard]] std::optional<double> seconds_left() const;
};

[[nodiscard]] Progress progress_of(const RunBoard& board);

// Returns the progress in words: "120 of 1000 files (2 failed), 1.2 of 10.3 GB, 35 MB/s, 4 min
// left; dragon.ply 12 s, 1 more". Names are shown as printable() does.
[[nodiscard]] std::string text_of(const Progress& progress);

// Returns the progress as the object that --progress json prints.
[[nodiscard]] nlohmann::ordered_json json_of(const Progress& progress, std::string_view verb);

// Returns the time of a clock that all processes share, in milliseconds.
[[nodiscard]] std::uint64_t milliseconds_now();

// Returns the size of the file, or 0 where it cannot be told.
[[nodiscard]] std::uint64_t bytes_of_file(const std::filesystem::path& path);

}  // namespace triglyph
