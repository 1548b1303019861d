#include "engine/attack/stored_mesh.h"

#include <algorithm>

#include "engine/io/readers.h"
#include "engine/mesh/weld.h"

namespace triglyph {
namespace {

bool repeats_a_point(const Triangle& t) {
  return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

}  // namespace

// note: not by static_cast, since GCC 12 leaves conversions to float and back out where it
// vectorises them by threes (-ftree-slp-vectorize, -O2 and above).
Vec3 as_float(const Vec3& point) {
  Vec3 result;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    result[axis] = round_to(Scalar::Float32, point[axis]);
  }
  return result;
}

Mesh stored(const Mesh& mesh) {
  std::vector<Vec3> rounded(mesh.positions.size());
  std::transform(mesh.positions.begin(), mesh.positions.end(), rounded.begin(), as_float);
  Weld one = weld(rounded);
  Mesh result;
  result.positions = std::move(one.points);
  for (const Triangle& t : mesh.triangles) {
    const Triangle joined{one.point_of_vertex[t[0]], one.point_of_vertex[t[1]],
                          one.point_of_vertex[t[2]]};
    if (!repeats_a_point(joined)) result.triangles.push_back(joined);
  }
  return result;
}

Mesh compacted(std::span<const Vec3> points, std::span<const Triangle> triangles) {
  Mesh result;
  std::vector<char> used(points.size(), 0);
  for (const Triangle& t : triangles) {
    if (repeats_a_point(t)) continue;
    result.triangles.push_back(t);
    for (const std::uint32_t corner : t) used[corner] = 1;
  }
  std::vector<std::uint32_t> place(points.size(), 0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    place[i] = static_cast<std::uint32_t>(result.positions.size());
    if (used[i] != 0) result.positions.push_back(points[i]);
  }
  for (Triangle& t : result.triangles) t = {place[t[0]], place[t[1]], place[t[2]]};
  return result;
}

}  // namespace triglyph
