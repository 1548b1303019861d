// Writes the manual pages and the completion script into a directory: triglyph_manual DIR
#include <filesystem>
#include <fstream>
#include <iostream>

#include "cli/manual/completion.h"
#include "cli/manual/man_page.h"
#include "cli/verbs.h"
#include "render/arguments.h"

namespace {

bool write(const std::filesystem::path& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file) std::cerr << "triglyph_manual: " << path.string() << ": cannot be written\n";
  return !file.fail();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: triglyph_manual DIR\n";
    return 2;
  }
  const std::filesystem::path folder = argv[1];
  const std::string version = "triglyph " TRIGLYPH_VERSION;
  triglyph::Action action;
  const auto app = triglyph::make_app(action);
  triglyph::RenderArguments render_arguments;
  const auto render = triglyph::make_render_app(render_arguments);
  triglyph::declare_collection_options(*render);
  bool is_written =
      write(folder / "triglyph.1", triglyph::man_page(*app, "triglyph", version)) &&
      write(folder / "triglyph.bash", triglyph::bash_completion(*app, {{"render", render.get()}}));
  for (const CLI::App* verb : app->get_subcommands([](const CLI::App*) { return true; })) {
    const std::string& name = verb->get_name();
    is_written = is_written && write(folder / ("triglyph-" + name + ".1"),
                                     triglyph::man_page(name == "render" ? *render : *verb,
                                                        "triglyph " + name, version));
  }
  return is_written ? 0 : 1;
}
