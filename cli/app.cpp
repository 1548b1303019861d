#include "cli/app.h"

#include <exception>
#include <iostream>
#include <stdexcept>

#include "cli/config.h"
#include "cli/options.h"
#include "cli/verbs.h"
#include "engine/base/error.h"

namespace triglyph {
namespace {

int report(const std::exception& error, int code) {
  std::cerr << "triglyph: " << error.what() << "\n";
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
  add_verify_verb(*app, action);
  add_measure_verb(*app, action);
  add_render_verb(*app, action);
  add_sample_verb(*app, action);
  add_keygen_verb(*app, action);
  return app;
}

int run_app(int argc, char** argv) try {
  Action action;
  const auto app = make_app(action);
  try {
    app->parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app->exit(error) == 0 ? kDone : kUsageError;
  } catch (const std::invalid_argument& error) {
    return report(error, kUsageError);  // thrown by the parser for a bad value of a flag
  }
  return action();
} catch (const Error& error) {
  return report(error, exit_code_of(error.code()));
} catch (const std::exception& error) {
  return report(error, kFatal);
}

}  // namespace triglyph
