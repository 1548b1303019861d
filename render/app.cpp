#include "render/app.h"

#include <csignal>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "engine/base/error.h"
#include "engine/base/parallel.h"
#include "engine/io/mesh_file.h"
#include "engine/scheme/registry.h"
#include "render/colours.h"
#include "render/comparison.h"
#include "render/paper_figure.h"
#include "render/picture_file.h"

namespace triglyph {
namespace {

namespace fs = std::filesystem;

constexpr int kFatal = 1;
constexpr int kUsageError = 2;
constexpr int kSomeFailed = 3;

struct Arguments {
  fs::path original, marked, out;
  std::vector<std::string> panels;
  std::string paper_figure;  // scheme
  std::string background = "white";
  int turntable = 0;  // pictures
  int threads = 0;
  bool batch = false;
  PictureOptions picture;

  [[nodiscard]] std::vector<std::string> chosen_panels() const {
    if (!panels.empty()) return panels;
    if (marked.empty() && !batch) return {"original"};
    return {"original", "facets", "distance", "worst"};
  }
};

Colour background_named(const std::string& name) {
  if (name == "white") return {1, 1, 1, 1};
  if (name == "transparent") return {0, 0, 0, 0};
  std::size_t used = 0;
  unsigned long code = 0;
  try {
    code = std::stoul(name, &used, 16);
  } catch (const std::exception&) {
    used = 0;
  }
  if (name.size() != 6 || used != 6) {
    throw Error(ErrorCode::Usage, {}, "",
                "a background is white, transparent or RRGGBB, not '" + name + "'");
  }
  return from_srgb(static_cast<unsigned>(code));
}

// "pic.png" becomes "pic-007.png".
fs::path numbered(const fs::path& path, int number) {
  char suffix[16];
  std::snprintf(suffix, sizeof suffix, "-%03d", number);
  fs::path result = path;
  result.replace_filename(path.stem().string() + suffix + path.extension().string());
  return result;
}

void draw_pair(const Arguments& arguments, const fs::path& original, const fs::path& marked,
               const fs::path& out) {
  const MeshFile first = MeshFile::open(original);
  const auto panels = arguments.chosen_panels();
  const auto draw = [&](const Mesh& second, const PictureOptions& options, const fs::path& path) {
    write_picture(draw_comparison(first.mesh(), second, panels, options), path);
  };
  const auto draw_all = [&](const Mesh& second) {
    if (arguments.turntable == 0) return draw(second, arguments.picture, out);
    for (int i = 0; i < arguments.turntable; ++i) {
      PictureOptions options = arguments.picture;
      options.view = std::to_string(360.0 * i / arguments.turntable) + ",15";
      draw(second, options, numbered(out, i));
    }
  };
  if (marked.empty()) return draw_all(first.mesh());
  draw_all(MeshFile::open(marked).mesh());
}

volatile std::sig_atomic_t stop_requested = 0;

// Reads one JSON object per line from standard input: {"original", "marked", "out"}.
int draw_batch(const Arguments& arguments) {
  std::signal(SIGTERM, [](int) {
    stop_requested = 1;
  });  // takes effect between pictures, so that none is incomplete
  int code = 0;
  std::size_t number = 0;
  for (std::string line; stop_requested == 0 && std::getline(std::cin, line);) {
    ++number;
    try {
      const auto job = nlohmann::json::parse(line);
      draw_pair(arguments, job.at("original").get<std::string>(),
                job.at("marked").get<std::string>(), job.at("out").get<std::string>());
    } catch (const std::exception& error) {
      std::cerr << "triglyph-render: line " << number << ": " << error.what() << "\n";
      code = kSomeFailed;
    }
  }
  return stop_requested == 0 ? code : kSomeFailed;
}

int run(Arguments arguments) {
  arguments.picture.background = background_named(arguments.background);
  if (arguments.batch) return draw_batch(arguments);
  if (arguments.original.empty() || arguments.out.empty()) {
    throw Error(ErrorCode::Usage, {}, "", "a mesh to draw and --out are needed");
  }
  check_picture_name(arguments.out);  // before any work is done
  if (arguments.paper_figure.empty()) {
    draw_pair(arguments, arguments.original, arguments.marked, arguments.out);
  } else {
    const MeshFile file = MeshFile::open(arguments.original);
    write_picture(draw_paper_figure(file.mesh(), arguments.paper_figure, arguments.picture),
                  arguments.out);
  }
  return 0;
}

std::vector<std::string> strings(std::span<const std::string_view> names) {
  return {names.begin(), names.end()};
}

void add_options(CLI::App& app, Arguments& arguments) {
  app.add_option("original", arguments.original, "Original mesh")->type_name("MESH");
  app.add_option("marked", arguments.marked, "Mesh to compare with the original")
      ->type_name("MESH");
  app.add_option("--out", arguments.out, "Picture to write: .png, .jpg or .exr")->type_name("FILE");
  auto* panels = app.add_option("--panels", arguments.panels,
                                "1 to 6 panels, separated by commas:\n" +
                                    CLI::detail::join(strings(panel_names()), ", ") +
                                    "\n(default: original,facets,distance,worst)")
                     ->delimiter(',')
                     ->check(CLI::IsMember(strings(panel_names())).description(""))
                     ->type_name("NAME");
  app.add_option("--paper-figure", arguments.paper_figure,
                 "Draw the mesh, and its mark in this scheme without and with optimisation")
      ->check(CLI::IsMember(strings(scheme_names())).description(""))
      ->type_name(CLI::detail::join(strings(scheme_names()), "|"))
      ->excludes(panels);
  app.add_option("--width", arguments.picture.width, "Width of a panel in pixels (default: 640)")
      ->type_name("N");
  app.add_option("--height", arguments.picture.height,
                 "Height of a panel in pixels (default: as the mesh requires)")
      ->type_name("N");
  app.add_option("--samples", arguments.picture.samples, "Rays per pixel (default: 16)")
      ->type_name("N");
  app.add_option("--view", arguments.picture.view,
                 "auto, front, back, left, right, top, bottom, or AZIMUTH,ELEVATION in degrees;\n"
                 "with -z at the end the z axis points up (default: auto)")
      ->type_name("VIEW");
  app.add_option("--turntable", arguments.turntable,
                 "Number of views all round, written to FILE-000 .. (1 to 999)")
      ->check(CLI::Range(1, 999).description(""))
      ->type_name("N");
  app.add_option("--background", arguments.background,
                 "white, transparent or RRGGBB (default: white)")
      ->type_name("COLOUR");
  app.add_flag("--flat", arguments.picture.is_flat, "Shade every facet flat");
  app.add_option("--threads", arguments.threads, "Threads to use (1 to 1024; default: all)")
      ->check(CLI::Range(1, 1024).description(""))
      ->type_name("N");
  app.add_flag("--batch", arguments.batch,
               "Draw the pairs that standard input lists, one JSON object per line:\n"
               "{\"original\": MESH, \"marked\": MESH, \"out\": FILE}");
}

}  // namespace

int run_render_app(int argc, char** argv) try {
  CLI::App app("Draws meshes side by side, without a display.", "triglyph render");
  Arguments arguments;
  add_options(app, arguments);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kUsageError;
  }
  int code = 0;
  with_threads(arguments.threads, [&] { code = run(arguments); });
  return code;
} catch (const Error& error) {
  std::cerr << "triglyph-render: " << error.what() << "\n";
  return error.code() == ErrorCode::Unwritable ? kFatal : kUsageError;
} catch (const std::exception& error) {
  std::cerr << "triglyph-render: " << error.what() << "\n";
  return kFatal;
}

}  // namespace triglyph
