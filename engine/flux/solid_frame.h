// The frame of the solid that a mesh encloses: it moves with the mesh under every similarity, and
// hardly at all when the surface is remeshed, simplified or disturbed.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "engine/geometry/triangle.h"
#include "engine/mesh/point_faces.h"

namespace triglyph {

struct SolidFrame {
  Vec3 centre;       // of the volume, model units
  double scale = 1;  // kFrameScale times the root mean square distance to the centre, model units
  std::array<Vec3, 3> axes;         // principal axes, by descending spread, right-handed
  std::array<double, 3> spreads{};  // root mean squares along the axes, model units
  double orientation = 1;           // -1: triangles are clockwise seen from outside

  // Returns a point relative to the centre in units of the scale.
  [[nodiscard]] Vec3 relative(const Vec3& point) const { return (point - centre) / scale; }
};

// With this factor a ball's surface lies at distance 1.
inline constexpr double kFrameScale = 1.3;

// Returns the frame of a closed surface; nothing if it encloses next to no volume, as flat sheets
// do. The sign of an axis is that of the surface's third moment along it, a convention that a
// reader must not rely on. O(triangles), parallel.
[[nodiscard]] std::optional<SolidFrame> solid_frame(std::span<const Vec3> positions,
                                                    std::span<const Triangle> triangles);

// The first-order change of the frame's quantities when points move along given directions: three
// coordinates of the centre, the scale, and the three mixed second moments that turn the axes.
inline constexpr std::size_t kFrameRows = 7;

// Returns kFrameRows entries a direction, that is a point, dimensionless per model unit of move;
// for fewer directions than points, those of the first points, and the others stay where they are.
// A mark that keeps all rows at zero leaves the frame to a reader as it was. `faces` are those of
// the triangles. O(triangles), parallel.
[[nodiscard]] std::vector<std::array<double, kFrameRows>> frame_rows(
    std::span<const Vec3> positions, std::span<const Triangle> triangles, const PointFaces& faces,
    std::span<const Vec3> directions, const SolidFrame& frame);

}  // namespace triglyph
