// Triangulation of polygonal faces.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/mesh/mesh.h"

namespace triglyph {

// Polygons over file vertices: face f has the corners corners[ends[f - 1]] .. corners[ends[f] - 1].
struct Faces {
  std::vector<std::uint32_t> corners;
  std::vector<std::uint32_t> ends;
};

// Returns the triangles of all faces, in the order and with the orientation of the faces. A
// quadrangle is cut along its shorter diagonal, a larger polygon into a fan around the corner
// nearest to the mean of its corners (the one with the least sum of squared distances to the
// others). The result therefore depends neither on the corner a face starts at nor on translation,
// rotation and scale, except in ties, which go to the lexicographically smallest position.
// Triangles that repeat a point are left out; faces of fewer than three corners give none.
// O(corners).
// note: a concave polygon may be cut outside its outline.
[[nodiscard]] std::vector<Triangle> triangulate(const Faces& faces,
                                                std::span<const std::uint32_t> point_of_vertex,
                                                std::span<const Vec3> points);

}  // namespace triglyph
