#include "render/mesh_as_cut.h"

namespace triglyph {

Mesh mesh_as_cut_in(const MeshFile& original, const MeshFile& marked) {
  Mesh mesh = marked.mesh();
  const Mesh& before = original.mesh();
  const bool may_be_equal =
      marked.has_polygons() && mesh.positions.size() == before.positions.size();
  if (may_be_equal && marked.triangles_at(before.positions) == before.triangles) {
    mesh.triangles = before.triangles;
  }
  return mesh;
}

}  // namespace triglyph
