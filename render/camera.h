// Cameras. The projection is parallel, so lengths are comparable across a picture.
#pragma once

#include <limits>
#include <span>
#include <string>

#include "engine/mesh/mesh.h"

namespace triglyph {

struct Camera {
  Vec3 centre{0, 0, 0};  // the point in the middle of the picture, model units
  Vec3 right{1, 0, 0};   // unit vectors; right x up points to the viewer
  Vec3 up{0, 1, 0};
  double half_height = 1;  // from the middle to the upper border, model units
  // Depth of the near clipping plane in front of the centre, model units.
  double reach = std::numeric_limits<double>::infinity();

  [[nodiscard]] Vec3 towards_viewer() const { return cross(right, up); }
};

// A direction of view in degrees, turned about the vertical first, then raised. 0, 0 is the front.
struct View {
  double azimuth = 0;
  double elevation = 0;
  char vertical = 'y';  // axis of the model that points up, 'y' or 'z'
};

// Parses "front", "back", "left", "right", "top", "bottom" or "AZIMUTH,ELEVATION"; with ",z" or
// "-z" at the end the z axis points up. Throws Error Usage for other text.
[[nodiscard]] View view_named(const std::string& name);

// Returns the view from the front, a little to the side and from above, unless another of a few
// common views shows much more of the surface. O(triangles).
[[nodiscard]] View automatic_view(const Mesh& mesh);

// Returns the ratio of width to height of the projected points. Precondition: at least one point.
// O(points).
[[nodiscard]] double aspect_of(std::span<const Vec3> points, const View& view);

// Returns a camera that shows all points, with a margin, in a picture of this ratio of width to
// height.
[[nodiscard]] Camera whole_view(std::span<const Vec3> points, const View& view, double aspect);

// Returns a camera that shows a place along its normal, `half_height` model units around it, with
// the vertical of `like`.
[[nodiscard]] Camera close_view(const Vec3& place, const Vec3& normal, double half_height,
                                const Camera& like);

}  // namespace triglyph
