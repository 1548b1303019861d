#include "engine/mesh/fewer_triangles.h"

#include <limits>

#include <meshoptimizer.h>

#include "engine/geometry/box.h"

namespace triglyph {
namespace {

// Calls simplify(target, corners, points) with what meshoptimizer takes, where `simplify` returns
// how many corners are left of the target.
template <typename Simplify>
std::vector<Triangle> simplified_by(const Mesh& mesh, const Simplify& simplify) {
  // floats about the centre keep the most digits; they choose the points, and nothing else
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
  std::vector<unsigned int> left(corners.size());
  left.resize(simplify(left.data(), corners, points));
  std::vector<Triangle> triangles;
  triangles.reserve(left.size() / 3);
  for (std::size_t i = 0; i + 2 < left.size(); i += 3) {
    triangles.push_back({left[i], left[i + 1], left[i + 2]});
  }
  return triangles;
}

constexpr std::size_t kPointSize = 3 * sizeof(float);
constexpr float kAnyError = std::numeric_limits<float>::max();

}  // namespace

std::vector<Triangle> collapsed(const Mesh& mesh, std::size_t kept) {
  if (mesh.triangles.size() <= kept) return mesh.triangles;
  return simplified_by(mesh, [&](unsigned int* target, const std::vector<unsigned int>& corners,
                                 const std::vector<float>& points) {
    return meshopt_simplify(target, corners.data(), corners.size(), points.data(),
                            mesh.positions.size(), kPointSize, 3 * kept, kAnyError, 0, nullptr);
  });
}

std::vector<Triangle> clustered(const Mesh& mesh, std::size_t kept) {
  if (mesh.triangles.size() <= kept) return mesh.triangles;
  return simplified_by(mesh, [&](unsigned int* target, const std::vector<unsigned int>& corners,
                                 const std::vector<float>& points) {
    return meshopt_simplifySloppy(target, corners.data(), corners.size(), points.data(),
                                  mesh.positions.size(), kPointSize, 3 * kept, kAnyError, nullptr);
  });
}

}  // namespace triglyph
