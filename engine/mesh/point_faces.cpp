#include "engine/mesh/point_faces.h"

namespace triglyph {

PointFaces point_faces(const Mesh& mesh) {
  PointFaces result;
  std::vector<std::uint32_t>& offsets = result.offsets;
  offsets.assign(mesh.positions.size() + 1, 0);
  for (const Triangle& triangle : mesh.triangles) {
    for (const std::uint32_t point : triangle) ++offsets[point + 1];
  }
  for (std::size_t p = 0; p < mesh.positions.size(); ++p) offsets[p + 1] += offsets[p];
  result.faces.resize(3 * mesh.triangles.size());
  std::vector<std::uint32_t> next(offsets.begin(), offsets.end() - 1);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const std::uint32_t point : mesh.triangles[t]) result.faces[next[point]++] = t;
  }
  return result;
}

}  // namespace triglyph
