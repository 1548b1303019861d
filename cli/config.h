// Config files: TOML with a section a verb, whose keys are those of manifests and options.
#pragma once

#include <CLI/CLI.hpp>

namespace triglyph {

// Lets the app read --config. Unlike the parser's own reader it takes max_move for max-move, and
// refuses a key that is unknown, comes twice or has a value out of range with Error Malformed that
// names file, line and key.
void add_config_file(CLI::App& app);

}  // namespace triglyph
