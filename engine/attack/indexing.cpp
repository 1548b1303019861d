#include "engine/attack/indexing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

#include "engine/attack/stored_mesh.h"
#include "engine/base/random.h"
#include "engine/geometry/box.h"

namespace triglyph {
namespace {

std::vector<std::uint32_t> random_order(std::size_t size, std::uint64_t seed) {
  std::vector<std::uint32_t> order(size);
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return random_bits(seed, 0, a) < random_bits(seed, 0, b);
  });
  return order;
}

// The points that others may be welded to, in cubes as wide as the tolerance: whatever is near a
// point lies in its cube or in one of the 26 about it.
class KeptPoints {
 public:
  KeptPoints(const std::vector<Vec3>& points, double tolerance)
      : points_(points), tolerance_(tolerance) {}

  // Returns the first point kept within the tolerance, or keeps this one and returns it.
  std::uint32_t nearest_or_new(std::uint32_t point) {
    const Cube at = cube_of(points_[point]);
    std::uint32_t found = kNone;
    for (int i = 0; i < 27; ++i) {
      const Cube near{at[0] + i % 3 - 1, at[1] + i / 3 % 3 - 1, at[2] + i / 9 - 1};
      const auto cube = cubes_.find(near);
      if (cube == cubes_.end()) continue;
      for (const std::uint32_t kept : cube->second) {
        if ((points_[kept] - points_[point]).norm() < tolerance_) found = std::min(found, kept);
      }
    }
    if (found != kNone) return found;
    cubes_[at].push_back(point);
    return point;
  }

 private:
  using Cube = std::array<std::int64_t, 3>;
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  [[nodiscard]] Cube cube_of(const Vec3& p) const {
    Cube cube{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      cube[axis] = static_cast<std::int64_t>(std::floor(p[axis] / tolerance_));
    }
    return cube;
  }

  const std::vector<Vec3>& points_;
  double tolerance_;  // model units
  std::map<Cube, std::vector<std::uint32_t>> cubes_;
};

}  // namespace

Mesh reordered(const Mesh& mesh, std::uint64_t seed) {
  const auto points = random_order(mesh.positions.size(), seed);
  const auto faces = random_order(mesh.triangles.size(), seed + 1);
  std::vector<std::uint32_t> place(points.size());
  Mesh result;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    place[points[i]] = i;
    result.positions.push_back(mesh.positions[points[i]]);
  }
  for (const std::uint32_t face : faces) {
    const Triangle& old = mesh.triangles[face];
    const auto turn = static_cast<std::size_t>(random_bits(seed, 2, face) % 3);
    result.triangles.push_back(
        {place[old[turn]], place[old[(turn + 1) % 3]], place[old[(turn + 2) % 3]]});
  }
  return result;
}

Mesh flipped(const Mesh& mesh) {
  Mesh result = mesh;
  for (Triangle& t : result.triangles) std::swap(t[1], t[2]);
  return result;
}

Mesh as_soup(const Mesh& mesh) {
  Mesh result;
  for (const Triangle& t : mesh.triangles) {
    const auto first = static_cast<std::uint32_t>(result.positions.size());
    for (const std::uint32_t corner : t) result.positions.push_back(mesh.positions[corner]);
    result.triangles.push_back({first, first + 1, first + 2});
  }
  return result;
}

Mesh welded(const Mesh& mesh, double tolerance_rel_diag) {
  const double tolerance = tolerance_rel_diag * box_diagonal(mesh.positions);
  if (!(tolerance > 0)) return mesh;
  // about the box's corner, so that cubes have small numbers
  const Vec3 low = bounding_box(mesh.positions).low;
  std::vector<Vec3> points;
  for (const Vec3& p : mesh.positions) points.push_back(p - low);
  KeptPoints kept(points, tolerance);
  std::vector<std::uint32_t> place(points.size());
  for (std::uint32_t i = 0; i < place.size(); ++i) place[i] = kept.nearest_or_new(i);
  std::vector<Triangle> triangles;
  for (const Triangle& t : mesh.triangles) {
    triangles.push_back({place[t[0]], place[t[1]], place[t[2]]});
  }
  return compacted(mesh.positions, triangles);
}

}  // namespace triglyph
