#include <memory>
#include <string>
#include <vector>

#include "cli/sibling.h"
#include "cli/verbs.h"

namespace triglyph {

void add_render_verb(CLI::App& app, Action& action) {
  CLI::App* verb = app.add_subcommand(
      "render", "Draw meshes side by side, without a display (runs triglyph-render)");
  // all arguments, including --help, are passed to the renderer
  verb->prefix_command();
  verb->set_help_flag();
  verb->callback(
      [&action, verb] { action = [rest = verb->remaining()]() -> int { exec_renderer(rest); }; });
}

}  // namespace triglyph
