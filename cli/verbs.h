// One function a verb: registers its arguments with the app and leaves what to run in `action`.
#pragma once

#include <functional>

#include <CLI/CLI.hpp>

namespace triglyph {

// Runs the verb the user chose; returns an exit code.
using Action = std::function<int()>;

void add_keygen_verb(CLI::App& app, Action& action);
void add_mark_verb(CLI::App& app, Action& action);
void add_extract_verb(CLI::App& app, Action& action);
void add_verify_verb(CLI::App& app, Action& action);
void add_measure_verb(CLI::App& app, Action& action);
void add_render_verb(CLI::App& app, Action& action);
void add_sample_verb(CLI::App& app, Action& action);

}  // namespace triglyph
