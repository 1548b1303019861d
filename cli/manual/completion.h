// Completion of the command line in bash, made from the declared arguments.
#pragma once

#include <map>
#include <string>

#include <CLI/CLI.hpp>

namespace triglyph {

// Returns a script that completes the verbs of `app`, their options, and the values of options that
// are a choice, a file or a directory. A verb in `others` has that parser's options instead of its
// own: those of another executable.
[[nodiscard]] std::string bash_completion(const CLI::App& app,
                                          const std::map<std::string, const CLI::App*>& others);

}  // namespace triglyph
