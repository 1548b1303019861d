#include "engine/attack/parts.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <vector>

#include "engine/attack/motions.h"
#include "engine/attack/stored_mesh.h"
#include "engine/geometry/box.h"
#include "engine/mesh/edge_length.h"
#include "engine/samples/sample_shapes.h"

namespace triglyph {

Mesh cropped(const Mesh& mesh, double share_removed, std::uint64_t seed) {
  const Vec3 outwards = random_rotation(seed)[0];
  std::vector<double> heights;
  for (const Triangle& t : mesh.triangles) {
    heights.push_back(
        dot(outwards, mesh.positions[t[0]] + mesh.positions[t[1]] + mesh.positions[t[2]]));
  }
  std::vector<std::uint32_t> order(heights.size());
  std::iota(order.begin(), order.end(), 0U);
  const auto kept = static_cast<std::ptrdiff_t>(
      std::llround((1 - share_removed) * static_cast<double>(order.size())));
  if (kept < static_cast<std::ptrdiff_t>(order.size())) {
    std::nth_element(order.begin(), order.begin() + kept, order.end(),
                     [&](std::uint32_t a, std::uint32_t b) {
                       return std::tie(heights[a], a) < std::tie(heights[b], b);
                     });
  }
  order.resize(static_cast<std::size_t>(kept));
  std::sort(order.begin(), order.end());
  std::vector<Triangle> triangles;
  triangles.reserve(order.size());
  for (const std::uint32_t t : order) triangles.push_back(mesh.triangles[t]);
  return compacted(mesh.positions, triangles);
}

Mesh with_added_ball(const Mesh& mesh, double share, std::uint64_t seed) {
  if (mesh.triangles.empty()) return mesh;
  constexpr std::size_t kFewest = 80;
  const auto wanted = static_cast<std::size_t>(share * static_cast<double>(mesh.triangles.size()));
  const Mesh ball = make_sample_shape(SampleShape::Closed, std::max(kFewest, wanted), seed);
  const double scale = mean_edge_length(mesh) / mean_edge_length(ball);
  const Box box = bounding_box(mesh.positions);
  const Box ball_box = bounding_box(ball.positions);
  const Vec3 ball_centre = (ball_box.low + ball_box.high) / 2;
  // half diagonals reach from a box's centre to all of it
  const double distance = (box.size().norm() + scale * ball_box.size().norm()) / 2;
  const Vec3 place = (box.low + box.high) / 2 + 1.05 * distance * random_rotation(seed)[0];
  Mesh result = mesh;
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (const Vec3& p : ball.positions) {
    result.positions.push_back(place + scale * (p - ball_centre));
  }
  for (const Triangle& t : ball.triangles) {
    result.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  return result;
}

}  // namespace triglyph
