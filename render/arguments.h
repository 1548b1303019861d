// The arguments of triglyph-render.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "render/comparison.h"

namespace triglyph {

struct RenderArguments {
  std::filesystem::path original, marked, out;
  std::vector<std::string> panels;
  std::string paper_figure;  // scheme; empty: none
  std::string background = "white";
  int turntable = 0;  // pictures all round; 0: one picture
  int threads = 0;    // 0: all
  bool batch = false;
  bool answer = false;
  PictureOptions picture;

  // Returns the panels asked for, or those that suit the meshes given.
  [[nodiscard]] std::vector<std::string> chosen_panels() const;
};

// Returns the parser, which writes into `arguments`; these must outlive it.
[[nodiscard]] std::unique_ptr<CLI::App> make_render_app(RenderArguments& arguments);

}  // namespace triglyph
