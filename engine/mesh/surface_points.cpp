#include "engine/mesh/surface_points.h"

namespace triglyph {

std::vector<std::uint32_t> surface_points(const Mesh& mesh) {
  std::vector<bool> is_used(mesh.positions.size(), false);
  for (const Triangle& triangle : mesh.triangles) {
    for (const std::uint32_t point : triangle) is_used[point] = true;
  }
  std::vector<std::uint32_t> points;
  for (std::uint32_t p = 0; p < is_used.size(); ++p) {
    if (is_used[p]) points.push_back(p);
  }
  return points;
}

}  // namespace triglyph
