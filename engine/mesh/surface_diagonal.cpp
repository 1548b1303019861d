#include "engine/mesh/surface_diagonal.h"

#include "engine/base/parallel.h"
#include "engine/geometry/box.h"

namespace triglyph {

double surface_diagonal(const Mesh& mesh) {
  if (mesh.triangles.empty()) return 0;
  const auto box_of = [&](std::size_t t) {
    Box box;
    for (const std::uint32_t point : mesh.triangles[t]) box.extend(mesh.positions[point]);
    return box;
  };
  const auto join = [](Box box, const Box& other) {
    box.extend(other);
    return box;
  };
  return parallel_reduce(mesh.triangles.size(), Box{}, box_of, join).size().norm();
}

}  // namespace triglyph
