// From where a picture is taken. Projection is parallel, so sizes compare all over the picture.
#pragma once

#include <limits>
#include <span>
#include <string>

#include "engine/mesh/mesh.h"

namespace triglyph {

struct Camera {
  Vec3 centre{0, 0, 0};  // appears in the middle of the picture
  Vec3 right{1, 0, 0};   // unit vectors; right x up points to the viewer
  Vec3 up{0, 1, 0};
  double half_height = 1;  // from the middle to the upper border, model units
  // What lies farther from the centre towards the viewer is not seen, model units.
  double reach = std::numeric_limits<double>::infinity();

  [[nodiscard]] Vec3 towards_viewer() const { return cross(right, up); }
};

// Direction of view. Turned about the vertical first, then raised; degrees. 0, 0 is from the front.
struct View {
  double azimuth = 0;
  double elevation = 0;
  char vertical = 'y';  // axis of the model that points up, 'y' or 'z'
};

// "front", "back", "left", "right", "top", "bottom", "AZIMUTH,ELEVATION"; with ",z" or "-z" at the
// end the z axis points up. Throws Error Usage.
[[nodiscard]] View view_named(const std::string& name);

// From the front, a little to the side and from above, unless that shows much less of the surface
// than another of a few usual views. O(triangles).
[[nodiscard]] View automatic_view(const Mesh& mesh);

// Width over height of the points as they are seen. Precondition: at least one point. O(points).
[[nodiscard]] double aspect_of(std::span<const Vec3> points, const View& view);

// The whole of the points, with a margin, in a picture of the given shape (width / height).
[[nodiscard]] Camera whole_view(std::span<const Vec3> points, const View& view, double aspect);

// A place seen along its normal, `half_height` model units around it; `like` decides what is up.
[[nodiscard]] Camera close_view(const Vec3& place, const Vec3& normal, double half_height,
                                const Camera& like);

}  // namespace triglyph
