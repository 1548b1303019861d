#include "engine/mesh/uniform_flow.h"

#include <utility>

#include "engine/base/parallel.h"
#include "engine/geometry/conjugate_gradients.h"
#include "engine/mesh/edge_graph.h"

namespace triglyph {

UniformFlow::UniformFlow(const Mesh& mesh, double share) : share_(share) {
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
          next[point] += share_ * (sum / double(end - begin) - positions[point]);
        },
        kBlock);
    positions.swap(next);
  }
  return positions;
}

std::vector<Vec3> UniformFlow::unsmoothed(std::span<const Vec3> positions, int steps,
                                          int iterations) const {
  // Weighing each point by its neighbours makes the smoothing symmetric.
  std::vector<double> neighbours(positions.size());
  std::vector<Vec3> right(positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    neighbours[i] = offsets_[i + 1] - offsets_[i];
    right[i] = neighbours[i] * positions[i];
  }
  std::vector<Vec3> x(positions.begin(), positions.end());
  const ConjugateGradients solver{neighbours, iterations};
  solver.improve(x, right, [&](const std::vector<Vec3>& vectors, std::vector<Vec3>& image) {
    image = smoothed(vectors, steps);
    parallel_for(
        image.size(), [&](std::size_t i) { image[i] *= neighbours[i]; }, kBlock);
  });
  return x;
}

}  // namespace triglyph
