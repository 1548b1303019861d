// Config files: TOML with one section per verb, with the keys of manifests.
#pragma once

#include <CLI/CLI.hpp>

namespace triglyph {

// Adds the option --config to the app. Keys may be spelled with underscores. An unknown or repeated
// key and a value out of range are refused with Error Malformed, which names file, line and key;
// the parser's own reader does neither.
void add_config_file(CLI::App& app);

}  // namespace triglyph
