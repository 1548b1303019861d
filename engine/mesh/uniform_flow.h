// Laplacian smoothing of the points of a mesh with uniform weights, and its approximate inverse.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/mesh/mesh.h"

namespace triglyph {

// Share of the way in a step; that of the attacks in the field's benchmarks.
inline constexpr double kFlowStep = 0.1;

// Each step moves every point a share of the way to the mean of its neighbours.
class UniformFlow {
 public:
  // Does not refer to the mesh afterwards. O(t log t).
  explicit UniformFlow(const Mesh& mesh, double share = kFlowStep);

  // Returns the positions after `steps` steps. O(steps * points), parallel.
  [[nodiscard]] std::vector<Vec3> smoothed(std::vector<Vec3> positions, int steps) const;

  // Returns positions of which `steps` steps of smoothing give about the given ones, by so many
  // iterations of conjugate gradients: each brings back finer detail, and more of the noise.
  // Precondition: the share is less than a half. O(iterations * steps * points), parallel.
  [[nodiscard]] std::vector<Vec3> unsmoothed(std::span<const Vec3> positions, int steps,
                                             int iterations) const;

 private:
  double share_;
  std::vector<std::uint32_t> offsets_;
  std::vector<std::uint32_t> neighbours_;
};

}  // namespace triglyph
