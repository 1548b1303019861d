// Mean curvature flow: a direction along which a reader looks for what a surface was before.
#pragma once

#include <vector>

#include "engine/mesh/mesh.h"

namespace triglyph {

// Returns the positions after an implicit step of mean curvature flow over `time`, squared model
// units. By conjugate gradients: O(points * iterations), parallel.
// This work is based on:
// Desbrun, Meyer, Schroeder, Barr. Implicit fairing of irregular meshes using diffusion and
// curvature flow. SIGGRAPH (1999).
[[nodiscard]] std::vector<Vec3> curvature_flowed(const Mesh& mesh, double time);

}  // namespace triglyph
