#include "render/arguments.h"

#include <span>
#include <string_view>

#include "engine/scheme/registry.h"
#include "render/panels.h"

namespace triglyph {
namespace {

std::vector<std::string> strings(std::span<const std::string_view> names) {
  return {names.begin(), names.end()};
}

}  // namespace

std::vector<std::string> RenderArguments::chosen_panels() const {
  if (!panels.empty()) return panels;
  if (marked.empty() && !batch) return {"original"};
  return {"original", "facets", "distance", "worst"};
}

std::unique_ptr<CLI::App> make_render_app(RenderArguments& arguments) {
  auto parser = std::make_unique<CLI::App>("Draws meshes side by side, without a display.",
                                           "triglyph render");
  CLI::App& app = *parser;
  app.add_option("original", arguments.original,
                 "Original mesh; or two folders, records or a ledger, of which every pair is drawn "
                 "into the folder that --out names")
      ->type_name("MESH|DIR|RECORDS");
  app.add_option("marked", arguments.marked, "Mesh to compare with the original")
      ->type_name("MESH");
  app.add_option("--out", arguments.out, "Picture to write: .png, .jpg or .exr")->type_name("FILE");
  auto* panels = app.add_option("--panels", arguments.panels,
                                "1 to 6 panels, separated by commas: " +
                                    CLI::detail::join(strings(panel_names()), ", ") +
                                    " (default: original,facets,distance,worst)")
                     ->delimiter(',')
                     ->check(CLI::IsMember(strings(panel_names())).description(""))
                     ->type_name(CLI::detail::join(strings(panel_names()), "|"));
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
  app.add_flag("--answer", arguments.answer,
               "With --batch: print {} once it can begin, and for each line {} when its picture is "
               "there,\nor {\"status\": TEXT, \"error\": TEXT}; a line may say \"threads\": N");
  app.footer(
      "Draw a mesh, its marked copy and where they differ:\n"
      "  triglyph render a.obj marked/a.obj --out a.png --panels original,marked,distance\n"
      "Draw every mesh of a run, as a run with the options --json, --memory, --timeout,\n"
      "--max-failures, --fail-fast, --quiet and --ledger of measure:\n"
      "  triglyph render run.jsonl --out pictures --timeout 60");
  return parser;
}

}  // namespace triglyph
