// The command line: parses arguments, runs one verb, turns its end into an exit code.
#pragma once

namespace triglyph {

enum ExitCode : int {
  kDone = 0,
  kFatal = 1,         // the run could not go on
  kUsageError = 2,    // arguments, key file or manifest
  kSomeFailed = 3,    // finished, but not every mesh is as it should be
  kInterrupted = 130  // whole files only; the run can be repeated
};

[[nodiscard]] int run_app(int argc, char** argv);

}  // namespace triglyph
