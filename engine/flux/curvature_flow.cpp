#include "engine/flux/curvature_flow.h"

#include <algorithm>
#include <cmath>

#include "engine/base/parallel.h"
#include "engine/flux/cotangents.h"
#include "engine/geometry/conjugate_gradients.h"
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

}  // namespace

std::vector<Vec3> curvature_flowed(const Mesh& mesh, double time) {
  const FlowMatrix matrix(mesh, time);
  const std::size_t points = mesh.positions.size();
  std::vector<Vec3> right(points);
  for (std::size_t i = 0; i < points; ++i) right[i] = matrix.areas[i] * mesh.positions[i];
  std::vector<Vec3> x = mesh.positions;
  const ConjugateGradients solver{matrix.diagonal, kMostIterations, kTolerance};
  solver.improve(x, right, [&](std::span<const Vec3> vectors, std::vector<Vec3>& image) {
    parallel_for(
        points, [&](std::size_t i) { image[i] = matrix.row_times(vectors, i); }, kBlock);
  });
  return x;
}

}  // namespace triglyph
