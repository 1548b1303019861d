// Smoothing of the points of a mesh, and its approximate inverse: a reader undoes what smoothing,
// subdivision and decimation did to a mark.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/mesh/mesh.h"

namespace triglyph {

// Laplacian smoothing with uniform weights: each step moves every point a share of the way to the
// mean of its neighbours.
class UniformFlow {
 public:
  // Does not refer to the mesh afterwards. O(t log t).
  explicit UniformFlow(const Mesh& mesh);

  // Returns the positions after `steps` steps of kFlowStep. O(steps * points), parallel.
  [[nodiscard]] std::vector<Vec3> smoothed(std::vector<Vec3> positions, int steps) const;

  // Returns positions of which `steps` steps of smoothing give about the given ones, by so many
  // iterations of conjugate gradients: each brings back finer detail, and more of the noise.
  // O(iterations * steps * points), parallel.
  [[nodiscard]] std::vector<Vec3> unsmoothed(std::span<const Vec3> positions, int steps,
                                             int iterations) const;

 private:
  std::vector<std::uint32_t> offsets_;
  std::vector<std::uint32_t> neighbours_;
};

// Share of the way; that of the attacks in the field's benchmarks.
inline constexpr double kFlowStep = 0.1;

// Returns the positions after an implicit step of mean curvature flow over `time`, squared model
// units. By conjugate gradients: O(points * iterations), parallel.
// This work is based on:
// Desbrun, Meyer, Schroeder, Barr. Implicit fairing of irregular meshes using diffusion and
// curvature flow. SIGGRAPH (1999).
[[nodiscard]] std::vector<Vec3> curvature_flowed(const Mesh& mesh, double time);

}  // namespace triglyph
