// A mesh whose holes are closed, so that it encloses a solid. Flux through a surface and the frame
// of a solid need one; neither a reader nor a writer shows the caps to anybody.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/flux/solid_frame.h"
#include "engine/mesh/surface.h"

namespace triglyph {

// How much an edge of a boundary counts for the centre of its hole.
enum class EdgeWeight : std::uint8_t {
  Length,  // the centre does not depend on how finely the boundary is divided
  One,     // marks of the first builds with a flux layer
};

// Every connected boundary becomes a fan around one centre, the weighted mean of its edges'
// midpoints.
class ClosedMesh {
 public:
  // Closes the holes of a surface. Does not refer to the surface afterwards. O(triangles).
  explicit ClosedMesh(const Surface& surface, EdgeWeight weight = EdgeWeight::Length);

  // The triangles of the mesh, then those of the fans; centres are the points from points() on.
  [[nodiscard]] std::span<const Triangle> triangles() const { return triangles_; }
  // Returns the number of points of the mesh itself.
  [[nodiscard]] std::size_t points() const { return points_; }
  // Returns the number of holes that were closed.
  [[nodiscard]] std::size_t holes() const { return holes_; }

  // Returns the frame of the closed mesh; nothing if it encloses next to no volume, or if the fans
  // are so much larger than the mesh itself that it encloses nothing. `positions` are those of
  // with_centres(). O(triangles), parallel.
  [[nodiscard]] std::optional<SolidFrame> frame(std::span<const Vec3> positions) const;

  // Returns the positions followed by the centres that they give. O(points).
  [[nodiscard]] std::vector<Vec3> with_centres(std::span<const Vec3> positions) const;

 private:
  EdgeWeight weight_;
  std::size_t points_;
  std::size_t holes_ = 0;
  std::size_t own_triangles_ = 0;  // those before the fans
  std::vector<Triangle> triangles_;
};

}  // namespace triglyph
