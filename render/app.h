// The command line of triglyph-render.
#pragma once

namespace triglyph {

// Runs the program and returns an exit code: 0 done, 1 fatal, 2 usage or an unreadable mesh, 3 some
// pictures of a batch failed.
[[nodiscard]] int run_render_app(int argc, char** argv);

}  // namespace triglyph
