// The verbs. Each function adds a verb with its arguments to the app; if the user chooses the verb,
// parsing sets `action`.
#pragma once

#include <functional>
#include <memory>

#include <CLI/CLI.hpp>

namespace triglyph {

// Runs the verb that the user chose, and returns an exit code.
using Action = std::function<int()>;

// Returns the parser with every verb; `action` must outlive it.
[[nodiscard]] std::unique_ptr<CLI::App> make_app(Action& action);

void add_keygen_verb(CLI::App& app, Action& action);
void add_ledger_verb(CLI::App& app, Action& action);
void add_mark_verb(CLI::App& app, Action& action);
void add_extract_verb(CLI::App& app, Action& action);
void add_trace_verb(CLI::App& app, Action& action);
void add_verify_verb(CLI::App& app, Action& action);
void add_merge_verb(CLI::App& app, Action& action);
void add_sweep_verb(CLI::App& app, Action& action);
void add_measure_verb(CLI::App& app, Action& action);
void add_render_verb(CLI::App& app, Action& action);
void add_profile_verb(CLI::App& app, Action& action);
void add_sample_verb(CLI::App& app, Action& action);
void add_attack_verb(CLI::App& app, Action& action);
void add_survive_verb(CLI::App& app, Action& action);

// Replaces the renderer's --threads by the options that render takes for a collection. Their values
// go nowhere: this is for what is made from the declarations.
void declare_collection_options(CLI::App& renderer);

}  // namespace triglyph
