#include "engine/attack/simplification.h"

#include <cmath>

#include "engine/attack/stored_mesh.h"
#include "engine/mesh/fewer_triangles.h"

namespace triglyph {

Mesh simplified(const Mesh& mesh, double removed) {
  if (mesh.triangles.empty()) return mesh;
  const auto kept = static_cast<std::size_t>(
      std::llround((1 - removed) * static_cast<double>(mesh.triangles.size())));
  return compacted(mesh.positions, collapsed(mesh, kept));
}

}  // namespace triglyph
