#include "render/camera.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>

#include "engine/base/error.h"
#include "engine/base/parallel.h"
#include "engine/geometry/box.h"

namespace triglyph {
namespace {

constexpr double kMarginFactor = 1.06;
constexpr double kMinAreaShare = 0.75;  // of the greatest area that any of the views shows

// Returns the axes of the view in model coordinates.
Camera axes_of(const View& view) {
  const double azimuth = view.azimuth * M_PI / 180;
  const double elevation = view.elevation * M_PI / 180;
  // y points up, the viewer is at z
  Vec3 right(std::cos(azimuth), 0, -std::sin(azimuth));
  Vec3 up(-std::sin(azimuth) * std::sin(elevation), std::cos(elevation),
          -std::cos(azimuth) * std::sin(elevation));
  if (view.vertical == 'z') {  // z points up, the viewer is at -y
    right = Vec3(right[0], -right[2], right[1]);
    up = Vec3(up[0], -up[2], up[1]);
  }
  Camera camera;
  camera.right = right;
  camera.up = up;
  return camera;
}

// Returns the bounding box of the points in the axes of the camera.
Box box_in(std::span<const Vec3> points, const Camera& camera) {
  check(!points.empty(), "a view needs points");
  const Vec3 towards = camera.towards_viewer();
  Box box;
  for (const Vec3& point : points) {
    box.extend({dot(point, camera.right), dot(point, camera.up), dot(point, towards)});
  }
  return box;
}

// Returns the projected area of the surface, including back sides.
double shown_area(const Mesh& mesh, const Vec3& towards_viewer) {
  return parallel_reduce(
      mesh.triangles.size(), 0.0,
      [&](std::size_t t) {
        return std::abs(dot(area_normal(mesh.positions, mesh.triangles[t]), towards_viewer));
      },
      [](double a, double b) { return a + b; });
}

double number_from(const std::string& text, std::size_t begin, std::size_t end) {
  double value = 0;
  const char* last = text.data() + end;
  const auto [stop, error] = std::from_chars(text.data() + begin, last, value);
  if (error != std::errc{} || stop != last || !std::isfinite(value)) {
    throw Error(ErrorCode::Usage, {}, "", "no view named '" + text + "'");
  }
  return value;
}

}  // namespace

View view_named(const std::string& name) {
  View view;
  std::string text = name;
  if (text.size() > 2 && (text.ends_with(",z") || text.ends_with("-z"))) {
    view.vertical = 'z';
    text.resize(text.size() - 2);
  }
  struct Named {
    const char* name;
    double azimuth, elevation;
  };
  static constexpr std::array<Named, 6> kNamed = {{{"front", 0, 0},
                                                   {"right", 90, 0},
                                                   {"back", 180, 0},
                                                   {"left", -90, 0},
                                                   {"top", 0, 90},
                                                   {"bottom", 0, -90}}};
  for (const Named& named : kNamed) {
    if (text != named.name) continue;
    view.azimuth = named.azimuth;
    view.elevation = named.elevation;
    return view;
  }
  const std::size_t comma = text.find(',');
  if (comma == std::string::npos) {
    throw Error(ErrorCode::Usage, {}, "", "no view named '" + name + "'");
  }
  view.azimuth = number_from(text, 0, comma);
  view.elevation = number_from(text, comma + 1, text.size());
  return view;
}

View automatic_view(const Mesh& mesh) {
  static constexpr std::array<View, 6> kUsual = {
      {{20, 15, 'y'}, {110, 15, 'y'}, {20, 65, 'y'}, {20, 15, 'z'}, {110, 15, 'z'}, {20, 65, 'z'}}};
  std::array<double, kUsual.size()> areas{};
  for (std::size_t i = 0; i < kUsual.size(); ++i) {
    areas[i] = shown_area(mesh, axes_of(kUsual[i]).towards_viewer());
  }
  const double greatest = *std::max_element(areas.begin(), areas.end());
  const auto first = std::find_if(areas.begin(), areas.end(),
                                  [&](double area) { return area >= kMinAreaShare * greatest; });
  return kUsual[static_cast<std::size_t>(first - areas.begin()) % kUsual.size()];
}

double aspect_of(std::span<const Vec3> points, const View& view) {
  const Box box = box_in(points, axes_of(view));
  const Vec3 size = box.high - box.low;
  return size[1] > 0 ? size[0] / size[1] : std::numeric_limits<double>::infinity();
}

Camera whole_view(std::span<const Vec3> points, const View& view, double aspect) {
  Camera camera = axes_of(view);
  const Box box = box_in(points, camera);
  const Vec3 middle = (box.low + box.high) / 2;
  camera.centre =
      camera.right * middle[0] + camera.up * middle[1] + camera.towards_viewer() * middle[2];
  const Vec3 half = (box.high - box.low) / 2;
  camera.half_height = kMarginFactor * std::max(half[1], half[0] / aspect);
  if (!(camera.half_height > 0)) camera.half_height = half[2] > 0 ? half[2] : 1;
  return camera;
}

Camera close_view(const Vec3& place, const Vec3& normal, double half_height, const Camera& like) {
  Camera camera = like;
  camera.centre = place;
  camera.half_height = half_height;
  camera.reach = 2 * half_height;
  const double length = normal.norm();
  if (!(length > 0)) return camera;
  const Vec3 towards = normal / length;
  // keeps the vertical as far as the new direction allows
  const Vec3 up_hint =
      std::abs(dot(like.up, towards)) < 0.95 ? like.up : like.towards_viewer() * -1.0;
  const Vec3 right = cross(up_hint, towards);
  camera.right = right / right.norm();
  camera.up = cross(towards, camera.right);
  return camera;
}

}  // namespace triglyph
