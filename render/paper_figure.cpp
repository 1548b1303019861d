#include "render/paper_figure.h"

#include <algorithm>

#include "engine/marking/mark.h"
#include "engine/mesh/edge_graph.h"
#include "engine/mesh/surface_diagonal.h"
#include "engine/metric/hausdorff.h"
#include "engine/scheme/registry.h"
#include "render/colours.h"
#include "render/ray_caster.h"

namespace triglyph {
namespace {

constexpr double kUnitDotPixels = 1.8;  // radius of a moved point

std::vector<std::uint32_t> anchors_of(const Marking& marking) {
  std::vector<std::uint32_t> anchors;
  for (const Carrier& carrier : marking.carriers) anchors.push_back(carrier.anchor);
  return anchors;
}

// Returns the facets all of whose points belong to one unit.
std::vector<Colour> facets_of_units(const Mesh& mesh, const PointLists& units) {
  const EdgeGraph graph = edge_graph(mesh);
  std::vector<Colour> colours(mesh.triangles.size(), from_srgb(kClay));
  std::vector<std::uint32_t> unit_of(mesh.positions.size(), 0);  // from 1
  for (std::size_t u = 0; u < units.size(); ++u) {
    const auto number = static_cast<std::uint32_t>(u + 1);
    for (const std::uint32_t point : units[u]) unit_of[point] = number;
    const auto shade = [&](std::uint32_t face) {
      const Triangle& corners = mesh.triangles[face];
      if (std::all_of(corners.begin(), corners.end(),
                      [&](std::uint32_t point) { return unit_of[point] == number; })) {
        colours[face] = from_srgb(kMarkBlue);
      }
    };
    for (const std::uint32_t point : units[u]) {
      for (const EdgeGraph::Spoke& spoke : graph.around(point)) {
        for (const std::uint32_t face : graph.edges[spoke.edge].faces) {
          if (face != kNoFace) shade(face);
        }
      }
    }
  }
  return colours;
}

class PaperFigure {
 public:
  PaperFigure(const Mesh& mesh, const std::string& scheme, const PictureOptions& options)
      : mesh_(mesh),
        halfedges_(build_halfedges(mesh)),
        options_(options),
        camera_(camera_for(mesh, options)),
        mark_options_(default_mark_options(scheme, true)) {
    mark_options_.scheme_options = fixed_for(mesh, mark_options_.scheme_options);
    if (scheme == "iie") camera_.half_height += radius();  // for balls
  }

  Image draw() {
    const Marking best = marked();
    mark_options_.format = best.format;  // the same word format for both
    mark_options_.keeps_subscript_bits = true;
    mark_options_.layout.method = LayoutMethod::FirstFit;
    mark_options_.assign = AssignMethod::Sequential;
    const Marking plain = marked();
    std::vector<Panel> panels;
    panels.push_back({"original",
                      std::to_string(mesh_.positions.size()) + " points, " +
                          std::to_string(mesh_.triangles.size()) + " triangles",
                      draw(scene_of(mesh_)), std::nullopt});
    panels.push_back(panel("un-optimised", plain));
    panels.push_back(panel("optimised", best));
    return arrange(panels, options_.background);
  }

 private:
  // Returns the radius of the balls of iie in model units.
  [[nodiscard]] double radius() const {
    return number_in(mark_options_.scheme_options, "radius", 0);
  }

  [[nodiscard]] Marking marked() const {
    return mark(
        {mesh_, halfedges_}, Fill{}, Key::trial(), mark_options_,
        [](const Vec3& point) { return point; }, 0);
  }

  [[nodiscard]] Scene scene_of(const Mesh& mesh) const { return {mesh, options_.is_flat}; }

  [[nodiscard]] Image draw(const Scene& scene) const {
    return RayCaster(scene).draw(camera_, options_.width, options_.height, options_.samples);
  }

  [[nodiscard]] Panel panel(const std::string& title, const Marking& marking) const {
    const Mesh after{marking.positions, mesh_.triangles};
    Scene scene = scene_of(after);
    show_units(after, marking, scene);
    const double diagonal = surface_diagonal(mesh_);
    const double distance = hausdorff_of_move(mesh_.triangles, mesh_.positions, after.positions,
                                              kHausdorffTolerance * diagonal)
                                .symmetric();
    const std::string name = mark_options_.scheme == "tsq"   ? " units, facets shaded"
                             : mark_options_.scheme == "aie" ? " units, moved points"
                                                             : " units, balls";
    return {title + ": " + std::to_string(marking.carriers.size()) + name,
            "Hausdorff distance " + short_number(100 * distance / diagonal) + " % of the diagonal",
            draw(scene), std::nullopt};
  }

  void show_units(const Mesh& after, const Marking& marking, Scene& scene) const {
    const std::vector<std::uint32_t> anchors = anchors_of(marking);
    if (mark_options_.scheme == "aie") {
      const double radius = kUnitDotPixels * 2 * camera_.half_height / options_.height;
      for (std::size_t p = 0; p < after.positions.size(); ++p) {
        if (after.positions[p] != mesh_.positions[p]) {
          scene.dots.push_back({after.positions[p], radius});
        }
      }
      return;
    }
    if (mark_options_.scheme == "iie") {
      const EdgeGraph graph = edge_graph(after);
      for (const std::uint32_t anchor : anchors) {
        scene.balls.push_back({ball_centre(after, graph, anchor), radius()});
      }
      return;
    }
    const auto scheme = make_scheme(mark_options_.scheme, WordCode(Key::trial(), marking.format),
                                    mark_options_.scheme_options);
    scene.face_colours =
        facets_of_units(after, scheme->bind({after, halfedges_})->points_of(anchors));
  }

  // Returns the mean of an anchor and its one-ring.
  [[nodiscard]] static Vec3 ball_centre(const Mesh& mesh, const EdgeGraph& graph,
                                        std::uint32_t anchor) {
    Vec3 sum = mesh.positions[anchor];
    for (const EdgeGraph::Spoke& spoke : graph.around(anchor)) sum += mesh.positions[spoke.to];
    return sum / static_cast<double>(graph.around(anchor).size() + 1);
  }

  const Mesh& mesh_;
  Halfedges halfedges_;
  const PictureOptions& options_;
  Camera camera_;
  MarkOptions mark_options_;
};

}  // namespace

Image draw_paper_figure(const Mesh& mesh, const std::string& scheme,
                        const PictureOptions& options) {
  const PictureOptions settled = drawable(mesh, options);
  return PaperFigure(mesh, scheme, settled).draw();
}

}  // namespace triglyph
