// Polygons cut into triangles.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/mesh/mesh.h"

namespace triglyph {

// Polygons: face f has the corners [ends[f - 1], ends[f]) of file vertices.
struct Faces {
  std::vector<std::uint32_t> corners;
  std::vector<std::uint32_t> ends;
};

// Cuts every face into triangles that do not depend on the corner the face starts at, nor on
// place, size and orientation of the model: a quadrangle along its shorter diagonal, a larger
// polygon into a fan around the corner nearest to the mean of its corners (which has the least sum
// of squared distances to the others). Ties go to the lexicographically smallest position, and
// those do turn with the model. Triangles keep the order and the sense of their faces; one that
// repeats a point is left out, and faces of less than three corners give none.
// note: concave polygons may be cut outside their outline. O(corners).
[[nodiscard]] std::vector<Triangle> triangulate(const Faces& faces,
                                                std::span<const std::uint32_t> point_of_vertex,
                                                std::span<const Vec3> points);

}  // namespace triglyph
