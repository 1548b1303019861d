#include "engine/flux/surface_flow.h"

#include <algorithm>
#include <cmath>

#include "engine/base/parallel.h"
#include "engine/flux/cotangents.h"
#include "engine/mesh/edge_graph.h"
#include "engine/mesh/point_faces.h"

namespace triglyph {
namespace {

// Residual, in relation to the right side, and iterations at which the flow is near enough: it is a
// direction to search along, no result.
constexpr double kTolerance = 1e-5;
constexpr int kMostIterations = 60;

// M + time * L of the cotangent Laplacian L, row by row.
struct FlowMatrix {
  std::vector<double> areas;  // M
  std::vector<double> diagonal;
  std::vector<std::uint32_t> offsets;
  std::vector<std::uint32_t> columns;
  std::vector<double> values;

  FlowMatrix(const Mesh& mesh, double time);

  [[nodiscard]] Vec3 row_times(std::span<const Vec3> vectors, std::size_t row) const {
    Vec3 sum = diagonal[row] * vectors[row];
    for (std::uint32_t at = offsets[row]; at < offsets[row + 1]; ++at) {
      sum += values[at] * vectors[columns[at]];
    }
    return sum;
  }
};

FlowMatrix::FlowMatrix(const Mesh& mesh, double time) {
  const std::size_t points = mesh.positions.size();
  const PointFaces faces = point_faces(mesh);
  areas = point_areas(mesh);
  diagonal = areas;
  // two entries a face at each point; neighbours repeat, which does no harm
  offsets.assign(points + 1, 0);
  for (std::size_t point = 0; point < points; ++point) {
    const auto count = faces.at(static_cast<std::uint32_t>(point)).size();
    offsets[point + 1] = offsets[point] + 2 * static_cast<std::uint32_t>(count);
  }
  columns.resize(offsets.back());
  values.resize(offsets.back());
  parallel_for(
      points,
      [&](std::size_t point) {
        std::uint32_t at = offsets[point];
        for (const std::uint32_t face : faces.at(static_cast<std::uint32_t>(point))) {
          const Triangle& t = mesh.triangles[face];
          const auto corner =
              static_cast<std::size_t>(std::find(t.begin(), t.end(), point) - t.begin());
          for (const std::size_t end : {(corner + 1) % 3, (corner + 2) % 3}) {
            // the edge to `end` is opposite to the third corner
            const std::uint32_t apex = t[3 - corner - end];
            const double weight =
                time * cotangent_weight(mesh.positions[apex], mesh.positions[point],
                                        mesh.positions[t[end]]);
            columns[at] = t[end];
            values[at++] = -weight;
            diagonal[point] += weight;
          }
        }
      },
      kBlock);
}

Vec3 dot_each(std::span<const Vec3> a, std::span<const Vec3> b) {
  return parallel_reduce(
      a.size(), Vec3{},
      [&](std::size_t i) { return Vec3(a[i][0] * b[i][0], a[i][1] * b[i][1], a[i][2] * b[i][2]); },
      [](Vec3 x, const Vec3& y) { return x += y; });
}

Vec3 times_each(const Vec3& a, const Vec3& b) {
  return {a[0] * b[0], a[1] * b[1], a[2] * b[2]};
}

Vec3 over_each(const Vec3& a, const Vec3& b) {
  Vec3 result;
  for (std::size_t axis = 0; axis < 3; ++axis) result[axis] = b[axis] > 0 ? a[axis] / b[axis] : 0;
  return result;
}

}  // namespace

UniformFlow::UniformFlow(const Mesh& mesh) {
  const EdgeGraph graph = edge_graph(mesh);
  offsets_ = graph.offsets;
  neighbours_.reserve(graph.spokes.size());
  for (const EdgeGraph::Spoke& spoke : graph.spokes) neighbours_.push_back(spoke.to);
}

std::vector<Vec3> UniformFlow::smoothed(std::vector<Vec3> positions, int steps) const {
  std::vector<Vec3> next(positions.size());
  for (int step = 0; step < steps; ++step) {
    parallel_for(
        positions.size(),
        [&](std::size_t point) {
          const std::uint32_t begin = offsets_[point];
          const std::uint32_t end = offsets_[point + 1];
          next[point] = positions[point];
          if (begin == end) return;
          Vec3 sum;
          for (std::uint32_t at = begin; at < end; ++at) sum += positions[neighbours_[at]];
          next[point] += kFlowStep * (sum / double(end - begin) - positions[point]);
        },
        kBlock);
    positions.swap(next);
  }
  return positions;
}

std::vector<Vec3> UniformFlow::unsmoothed(std::span<const Vec3> positions, int steps,
                                          int iterations) const {
  // Smoothing is symmetric in the inner product that weighs each point by its neighbours.
  const auto weighted_dot = [&](std::span<const Vec3> a, std::span<const Vec3> b) {
    return parallel_reduce(
        a.size(), Vec3{},
        [&](std::size_t i) {
          return double(offsets_[i + 1] - offsets_[i]) * times_each(a[i], b[i]);
        },
        [](Vec3 x, const Vec3& y) { return x += y; });
  };
  std::vector<Vec3> x(positions.begin(), positions.end());
  std::vector<Vec3> rest = smoothed(x, steps);
  parallel_for(
      x.size(), [&](std::size_t i) { rest[i] = positions[i] - rest[i]; }, kBlock);
  std::vector<Vec3> direction = rest;
  Vec3 size = weighted_dot(rest, rest);
  for (int iteration = 0; iteration < iterations; ++iteration) {
    const std::vector<Vec3> image = smoothed(direction, steps);
    const Vec3 length = over_each(size, weighted_dot(direction, image));
    parallel_for(
        x.size(),
        [&](std::size_t i) {
          x[i] += times_each(length, direction[i]);
          rest[i] -= times_each(length, image[i]);
        },
        kBlock);
    const Vec3 next = weighted_dot(rest, rest);
    const Vec3 turn = over_each(next, size);
    parallel_for(
        x.size(), [&](std::size_t i) { direction[i] = rest[i] + times_each(turn, direction[i]); },
        kBlock);
    size = next;
  }
  return x;
}

std::vector<Vec3> curvature_flowed(const Mesh& mesh, double time) {
  const FlowMatrix matrix(mesh, time);
  const std::size_t points = mesh.positions.size();
  std::vector<Vec3> x = mesh.positions;
  std::vector<Vec3> rest(points);
  std::vector<Vec3> scaled(points);
  std::vector<Vec3> direction(points);
  std::vector<Vec3> image(points);
  const auto each = [&](const auto& body) { parallel_for(points, body, kBlock); };
  each([&](std::size_t i) {
    rest[i] = matrix.areas[i] * mesh.positions[i] - matrix.row_times(x, i);
    scaled[i] = rest[i] / matrix.diagonal[i];
    direction[i] = scaled[i];
  });
  Vec3 size = dot_each(rest, scaled);
  const double enough = kTolerance * kTolerance * size.max();
  for (int iteration = 0; iteration < kMostIterations && size.max() > enough; ++iteration) {
    each([&](std::size_t i) { image[i] = matrix.row_times(direction, i); });
    const Vec3 length = over_each(size, dot_each(direction, image));
    each([&](std::size_t i) {
      x[i] += times_each(length, direction[i]);
      rest[i] -= times_each(length, image[i]);
      scaled[i] = rest[i] / matrix.diagonal[i];
    });
    const Vec3 next = dot_each(rest, scaled);
    const Vec3 turn = over_each(next, size);
    each([&](std::size_t i) { direction[i] = scaled[i] + times_each(turn, direction[i]); });
    size = next;
  }
  return x;
}

}  // namespace triglyph
