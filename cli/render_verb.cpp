#include <memory>
#include <string>
#include <vector>

#include "cli/sibling.h"
#include "cli/verbs.h"

namespace triglyph {

void add_render_verb(CLI::App& app, Action& action) {
  CLI::App* verb = app.add_subcommand(
      "render", "Draw meshes beside each other, without a display (triglyph-render)");
  // all arguments are the renderer's, --help among them
  verb->prefix_command();
  verb->set_help_flag();
  verb->callback(
      [&action, verb] { action = [rest = verb->remaining()]() -> int { become_renderer(rest); }; });
}

}  // namespace triglyph
