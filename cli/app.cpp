#include "cli/app.h"

#include <algorithm>
#include <csignal>
#include <exception>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "cli/config.h"
#include "cli/options.h"
#include "cli/run_arguments.h"
#include "cli/screen.h"
#include "cli/verbs.h"
#include "engine/base/error.h"
#include "engine/base/text.h"

namespace triglyph {
namespace {

int report(const std::exception& error, int code) {
  std::cerr << "triglyph: " << printable(error.what()) << "\n";
  return code;
}

// Errors in arguments, key files and manifests are usage errors; others are fatal.
int exit_code_of(ErrorCode code) {
  switch (code) {
    case ErrorCode::Usage:
    case ErrorCode::Unreadable:
    case ErrorCode::Malformed:
    case ErrorCode::Unsupported:
      return kUsageError;
    case ErrorCode::Unwritable:
      return kFatal;
  }
  return kFatal;
}

// Names the verb or option that a mistyped word is closest to, if it is close to one.
void suggest(const CLI::App& app, int argc, char** argv) {
  const auto verbs = app.get_subcommands([](const CLI::App*) { return true; });
  std::vector<std::string> known;
  const CLI::App* chosen = nullptr;
  for (const CLI::App* verb : verbs) {
    known.push_back(verb->get_name());
    if (argc > 1 && verb->get_name() == argv[1]) chosen = verb;
  }
  if (chosen != nullptr) {
    known.clear();
    for (const CLI::Option* option : chosen->get_options()) {
      for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
    }
  }
  for (int i = chosen == nullptr ? 1 : 2; i < argc; ++i) {
    const std::string word = std::string(argv[i]).substr(0, std::string(argv[i]).find('='));
    const bool is_option = word.rfind("--", 0) == 0;
    if (is_option == (chosen == nullptr)) continue;
    if (std::find(known.begin(), known.end(), word) != known.end()) continue;
    if (const auto closest = closest_word(word, known)) {
      std::cerr << "triglyph: did you mean " << *closest << "?\n";
    }
    return;
  }
}

}  // namespace

std::unique_ptr<CLI::App> make_app(Action& action) {
  auto app = std::make_unique<CLI::App>(
      "Hides a blind, invisible watermark in meshes and reads it back.", "triglyph");
  app->set_version_flag("--version", "triglyph " TRIGLYPH_VERSION);
  app->formatter(make_help_formatter());  // the verbs take it over
  add_config_file(*app);
  app->require_subcommand(1);
  add_mark_verb(*app, action);
  add_extract_verb(*app, action);
  add_trace_verb(*app, action);
  add_verify_verb(*app, action);
  add_sweep_verb(*app, action);
  add_measure_verb(*app, action);
  add_render_verb(*app, action);
  add_attack_verb(*app, action);
  add_survive_verb(*app, action);
  add_profile_verb(*app, action);
  add_sample_verb(*app, action);
  add_ledger_verb(*app, action);
  add_merge_verb(*app, action);
  add_keygen_verb(*app, action);
  return app;
}

int run_app(int argc, char** argv) try {
  std::signal(SIGUSR1, SIG_IGN);  // which asks a run how far it is, and other verbs nothing
  std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow is an error of its own
  set_command_line(argc, argv);
  Action action;
  const auto app = make_app(action);
  try {
    app->parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (app->exit(error) != 0) {
      suggest(*app, argc, argv);
      return kUsageError;
    }
    check_standard_output();
    return kDone;
  } catch (const std::invalid_argument& error) {
    return report(error, kUsageError);  // thrown by the parser for a bad value of a flag
  }
  const int code = action();
  check_standard_output();
  return code;
} catch (const Error& error) {
  return report(error, exit_code_of(error.code()));
} catch (const std::exception& error) {
  return report(error, kFatal);
}

}  // namespace triglyph
