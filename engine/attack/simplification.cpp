#include "engine/attack/simplification.h"

#include <cmath>
#include <limits>
#include <vector>

#include <meshoptimizer.h>

#include "engine/attack/stored_mesh.h"
#include "engine/geometry/box.h"

namespace triglyph {

Mesh simplified(const Mesh& mesh, double removed) {
  if (mesh.triangles.empty()) return mesh;
  // floats about the centre keep the most digits; they order the collapses, and nothing else
  const Box box = bounding_box(mesh.positions);
  const Vec3 centre = (box.low + box.high) / 2;
  std::vector<float> points;
  points.reserve(3 * mesh.positions.size());
  for (const Vec3& p : mesh.positions) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      points.push_back(static_cast<float>(p[axis] - centre[axis]));
    }
  }
  std::vector<unsigned int> corners;
  corners.reserve(3 * mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) corners.insert(corners.end(), t.begin(), t.end());
  const auto kept = static_cast<std::size_t>(
      std::llround((1 - removed) * static_cast<double>(mesh.triangles.size())));
  std::vector<unsigned int> left(corners.size());
  left.resize(meshopt_simplify(left.data(), corners.data(), corners.size(), points.data(),
                               mesh.positions.size(), 3 * sizeof(float), 3 * kept,
                               std::numeric_limits<float>::max(), 0, nullptr));
  std::vector<Triangle> triangles;
  for (std::size_t i = 0; i + 2 < left.size(); i += 3) {
    triangles.push_back({left[i], left[i + 1], left[i + 2]});
  }
  return compacted(mesh.positions, triangles);
}

}  // namespace triglyph
