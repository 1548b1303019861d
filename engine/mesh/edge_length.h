// The length by which local sizes are measured.
#pragma once

#include "engine/mesh/mesh.h"

namespace triglyph {

// Mean length of the triangles' sides, an inner edge counting twice; 0 without any. Model units.
// O(triangles), parallel.
[[nodiscard]] double mean_edge_length(const Mesh& mesh);

}  // namespace triglyph
