// The faces at each point, in compressed rows.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/mesh/mesh.h"

namespace triglyph {

struct PointFaces {
  std::vector<std::uint32_t> offsets;
  std::vector<std::uint32_t> faces;

  // Returns the faces that have the point as a corner, ascending.
  [[nodiscard]] std::span<const std::uint32_t> at(std::uint32_t point) const {
    return {faces.data() + offsets[point], faces.data() + offsets[point + 1]};
  }
};

// Returns the faces of all points. O(points + triangles).
[[nodiscard]] PointFaces point_faces(const Mesh& mesh);

}  // namespace triglyph
