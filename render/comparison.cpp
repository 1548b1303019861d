#include "render/comparison.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "engine/base/error.h"
#include "engine/base/parallel.h"
#include "engine/geometry/spatial_index.h"
#include "engine/mesh/edge_length.h"
#include "engine/mesh/surface_diagonal.h"
#include "engine/mesh/surface_points.h"
#include "engine/metric/comparison.h"
#include "engine/metric/hausdorff.h"
#include "render/colours.h"
#include "render/ray_caster.h"

namespace triglyph {
namespace {

constexpr std::size_t kMostPanels = 6;
constexpr int kLeastPixels = 64;
constexpr double kNarrowest = 0.8;  // least width / height of panels whose height suits the mesh
constexpr double kWidest = 1.8;
constexpr int kMostPixels = 16384;  // per side; larger images exhaust memory
constexpr int kMostSamples = 4096;
constexpr double kCloseEdges = 5;      // mean edge lengths from the middle of "worst" to its border
constexpr double kCloseDistances = 8;  // and at least this many times the distance shown
constexpr double kEdgePixels = 1.2;    // width of drawn edges
constexpr double kDotPixels = 3;       // radius of a moved point

constexpr std::array<std::string_view, 7> kPanels = {"original", "marked", "facets", "points",
                                                     "distance", "signed", "worst"};

// Draws a ring around the centre of a close-up.
void draw_ring(int x, int y, int radius, Image& picture) {
  for (int dy = -radius - 1; dy <= radius + 1; ++dy) {
    for (int dx = -radius - 1; dx <= radius + 1; ++dx) {
      const double off = std::abs(std::hypot(dx, dy) - radius);
      const auto cover = static_cast<float>(std::clamp(1.8 - off, 0.0, 1.0));
      Colour& pixel = picture.at(x + dx, y + dy);
      pixel = over(times(from_srgb(0xd02030), cover), pixel);
    }
  }
}

// What is to be in the picture.
std::vector<Vec3> places_on_surface(const Mesh& mesh) {
  std::vector<Vec3> places;
  for (const std::uint32_t point : surface_points(mesh)) places.push_back(mesh.positions[point]);
  return places;
}

constexpr const char* kUnrelated = "other triangles than the original: none can be compared";

View view_for(const Mesh& mesh, const PictureOptions& options) {
  return options.view == "auto" ? automatic_view(mesh) : view_named(options.view);
}

class Comparison {
 public:
  Comparison(const Mesh& original, const Mesh& marked, const PictureOptions& options)
      : original_(original),
        marked_(marked),
        options_(options),
        camera_(camera_for(original, options)),
        diagonal_(surface_diagonal(original)),
        has_same_triangles_(have_same_triangles(original, marked)) {}

  Panel panel(const std::string& name) {
    if (name == "original") return plain("original", original_, options_.original_name);
    if (name == "facets") return facets();
    if (name == "points") return points();
    if (name == "distance") return heat(false);
    if (name == "signed") return heat(true);
    if (name == "worst") return worst();
    return plain(title_of_second(), marked_, options_.marked_name);
  }

 private:
  [[nodiscard]] Scene scene_of(const Mesh& mesh) const { return {mesh, options_.is_flat}; }

  [[nodiscard]] Image draw(const Scene& scene) const {
    return RayCaster(scene).draw(camera_, options_.width, options_.height, options_.samples);
  }

  // A mesh of other triangles may be anything; one whose points are all where they were has no
  // mark.
  [[nodiscard]] std::string title_of_second() const {
    if (!has_same_triangles_) return "compared";
    return original_.positions == marked_.positions ? "unchanged" : "marked";
  }

  [[nodiscard]] static std::string counts_of(const Mesh& mesh, const std::string& name) {
    return (name.empty() ? "" : name + ", ") + std::to_string(mesh.positions.size()) + " points, " +
           std::to_string(mesh.triangles.size()) + " triangles";
  }

  Panel plain(const std::string& title, const Mesh& mesh, const std::string& name) {
    return {title, counts_of(mesh, name), draw(scene_of(mesh)), std::nullopt};
  }

  Panel facets() {
    Scene scene = scene_of(marked_);
    std::size_t moved = 0;
    if (has_same_triangles_) {
      const std::vector<bool> is_moved = moved_facets(original_, marked_);
      scene.face_colours.assign(marked_.triangles.size(), from_srgb(kClay));
      for (std::size_t t = 0; t < is_moved.size(); ++t) {
        if (!is_moved[t]) continue;
        scene.face_colours[t] = from_srgb(kMarkBlue);
        ++moved;
      }
    }
    const std::string note =
        std::to_string(moved) + " of " + std::to_string(marked_.triangles.size()) + " facets";
    return {title_of_second() + ", moved facets shaded", has_same_triangles_ ? note : kUnrelated,
            draw(scene), std::nullopt};
  }

  Panel points() {
    Scene scene = scene_of(marked_);
    const double radius = kDotPixels * 2 * camera_.half_height / options_.height;
    if (has_same_triangles_) {
      for (std::size_t p = 0; p < marked_.positions.size(); ++p) {
        if (marked_.positions[p] != original_.positions[p]) {
          scene.dots.push_back({marked_.positions[p], radius});
        }
      }
    }
    const std::string note = std::to_string(scene.dots.size()) + " of " +
                             std::to_string(marked_.positions.size()) + " points";
    return {title_of_second() + ", moved points", has_same_triangles_ ? note : kUnrelated,
            draw(scene), std::nullopt};
  }

  Panel heat(bool with_sign) {
    const std::vector<double> far = distances(original_, marked_, with_sign);
    // The scale reaches to the distance that the record states, which may lie between the points.
    double greatest = farthest().symmetric();
    for (const double distance : far) greatest = std::max(greatest, std::abs(distance));
    Scene scene = scene_of(marked_);
    const double whole = greatest > 0 ? greatest : 1;
    for (const double distance : far) {
      scene.point_colours.push_back(with_sign ? signed_colour(distance / whole)
                                              : heat_colour(distance / whole));
    }
    return {with_sign ? "distance, % of the diagonal, > 0 outside"
                      : "distance from the original, % of the diagonal",
            "", draw(scene), Scale{100 * greatest / diagonal_, with_sign}};
  }

  // Returns the Hausdorff distance, computed once.
  const HausdorffDistance& farthest() {
    if (farthest_) return *farthest_;
    const double tolerance = 1e-3 * std::max(diagonal_, std::numeric_limits<double>::min());
    farthest_ = has_same_triangles_ ? hausdorff_of_move(original_.triangles, original_.positions,
                                                        marked_.positions, tolerance * 1e-2)
                                    : hausdorff(original_, marked_, tolerance);
    return *farthest_;
  }

  // Draws before and after in half a panel each.
  Panel worst() {
    const HausdorffDistance& distance = farthest();
    const Vec3 place = distance.backward.distance >= distance.forward.distance
                           ? distance.backward.at
                           : distance.forward.at;
    const ClosestPoint on_original = SpatialIndex(original_.positions, original_.triangles)
                                         .closest(place, std::numeric_limits<double>::infinity());
    const Triangle& face = original_.triangles[on_original.triangle];
    const Vec3 normal = area_normal(original_.positions, face);
    const double around =
        std::min(camera_.half_height, std::max(kCloseEdges * mean_edge_length(around_face(face)),
                                               kCloseDistances * distance.symmetric()));
    const Camera close = close_view(place, normal, around, camera_);
    const int half = options_.width / 2 - 2;
    Image both(options_.width, options_.height);
    paste(closeup(original_, close, half), 0, 0, both);
    paste(closeup(marked_, close, half), options_.width - half, 0, both);
    for (const int left : {0, options_.width - half}) {
      draw_ring(left + half / 2, options_.height / 2, options_.height / 24, both);
    }
    return {"the farthest place, before and after",
            short_number(100 * distance.symmetric() / diagonal_) + " % of the diagonal",
            std::move(both), std::nullopt};
  }

  // Returns the triangles of the original that share a point with a face.
  [[nodiscard]] Mesh around_face(const Triangle& face) const {
    Mesh around{original_.positions, {}};
    for (const Triangle& triangle : original_.triangles) {
      if (std::find_first_of(triangle.begin(), triangle.end(), face.begin(), face.end()) !=
          triangle.end()) {
        around.triangles.push_back(triangle);
      }
    }
    return around;
  }

  [[nodiscard]] Image closeup(const Mesh& mesh, const Camera& close, int width) const {
    Scene scene(mesh, true);
    scene.edge_width = kEdgePixels * 2 * close.half_height / options_.height;
    return RayCaster(scene).draw(close, width, options_.height, options_.samples);
  }

  const Mesh& original_;
  const Mesh& marked_;
  const PictureOptions& options_;
  Camera camera_;
  double diagonal_;
  bool has_same_triangles_;
  std::optional<HausdorffDistance> farthest_;
};

}  // namespace

std::span<const std::string_view> panel_names() {
  return kPanels;
}

std::vector<bool> moved_facets(const Mesh& original, const Mesh& marked) {
  check(original.positions.size() == marked.positions.size(), "moved facets need the same points");
  std::vector<bool> is_moved(marked.triangles.size(), false);
  for (std::size_t t = 0; t < is_moved.size(); ++t) {
    const Triangle& corners = marked.triangles[t];
    is_moved[t] = std::any_of(corners.begin(), corners.end(), [&](std::uint32_t point) {
      return original.positions[point] != marked.positions[point];
    });
  }
  return is_moved;
}

std::vector<double> distances(const Mesh& original, const Mesh& marked, bool with_sign) {
  const SpatialIndex surface(original.positions, original.triangles);
  const std::vector<std::uint32_t> points = surface_points(marked);
  std::vector<double> far(marked.positions.size(), 0);
  parallel_for(
      points.size(),
      [&](std::size_t i) {
        const std::uint32_t p = points[i];
        const Vec3& point = marked.positions[p];
        const ClosestPoint near = surface.closest(point, std::numeric_limits<double>::infinity());
        far[p] = near.distance;
        if (!with_sign) return;
        const Vec3 normal = area_normal(original.positions, original.triangles[near.triangle]);
        if (dot(point - near.point, normal) < 0) far[p] = -far[p];
      },
      256);
  return far;
}

PictureOptions drawable(const Mesh& mesh, PictureOptions options) {
  const auto refuse = [](const std::string& why) { throw Error(ErrorCode::Usage, {}, "", why); };
  if (mesh.triangles.empty()) refuse("a mesh without faces cannot be drawn");
  const auto fits = [](int pixels) { return pixels >= kLeastPixels && pixels <= kMostPixels; };
  if (!fits(options.width) || (options.height != 0 && !fits(options.height))) {
    refuse("panels are " + std::to_string(kLeastPixels) + " to " + std::to_string(kMostPixels) +
           " pixels wide and high");
  }
  if (options.samples < 1 || options.samples > kMostSamples) {
    refuse("samples are 1 to " + std::to_string(kMostSamples) + " a pixel");
  }
  if (options.height == 0) {
    const double aspect = std::clamp(aspect_of(places_on_surface(mesh), view_for(mesh, options)),
                                     kNarrowest, kWidest);
    options.height = std::clamp(static_cast<int>(std::lround(options.width / aspect)), kLeastPixels,
                                kMostPixels);
  }
  return options;
}

Camera camera_for(const Mesh& mesh, const PictureOptions& options) {
  return whole_view(places_on_surface(mesh), view_for(mesh, options),
                    static_cast<double>(options.width) / options.height);
}

Image draw_comparison(const Mesh& original, const Mesh& marked,
                      const std::vector<std::string>& panels, const PictureOptions& wanted) {
  const PictureOptions options = drawable(original, wanted);
  (void)drawable(marked, wanted);
  if (panels.empty() || panels.size() > kMostPanels) {
    throw Error(ErrorCode::Usage, {}, "", "a picture has 1 to 6 panels");
  }
  for (const std::string& name : panels) {
    if (std::find(kPanels.begin(), kPanels.end(), name) == kPanels.end()) {
      throw Error(ErrorCode::Usage, {}, "", "no panel named '" + name + "'");
    }
  }
  Comparison comparison(original, marked, options);
  std::vector<Panel> drawn;
  drawn.reserve(panels.size());
  for (const std::string& name : panels) drawn.push_back(comparison.panel(name));
  return arrange(drawn, options.background);
}

}  // namespace triglyph
