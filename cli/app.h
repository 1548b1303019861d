// The command line: parses the arguments, runs one verb and returns an exit code.
#pragma once

#include <array>
#include <string_view>

namespace triglyph {

// Exit codes.
inline constexpr int kDone = 0;
inline constexpr int kFatal = 1;          // the run could not continue
inline constexpr int kUsageError = 2;     // arguments, key file or manifest
inline constexpr int kSomeFailed = 3;     // finished, but not every mesh is as it should be
inline constexpr int kNoMark = 4;         // every file was read, but some carry no mark
inline constexpr int kInterrupted = 130;  // all files written are complete; the run can be repeated

struct ExitCode {
  int code;
  std::string_view meaning;
};
inline constexpr std::array<ExitCode, 6> kExitCodes{
    {{kDone, "All was done, and every mesh is as it should be."},
     {kFatal, "The run could not go on."},
     {kUsageError, "The arguments, the key file or the manifest are wrong; nothing was done."},
     {kSomeFailed, "The run finished, but some meshes were refused, unreadable or altered."},
     {kNoMark,
      "Every file was read, but some carry no mark (extract), name nobody (trace) or changed "
      "(sweep)."},
     {kInterrupted, "The run was interrupted; every file that is there is whole."}}};

// Runs the program. Does not throw.
[[nodiscard]] int run_app(int argc, char** argv);

}  // namespace triglyph
