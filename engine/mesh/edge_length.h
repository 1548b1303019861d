// The mean edge length, to which the schemes relate local sizes.
#pragma once

#include "engine/mesh/mesh.h"

namespace triglyph {

// Returns the mean length of the triangles' sides in model units; an edge of two triangles counts
// twice. 0 without triangles. O(triangles), parallel.
[[nodiscard]] double mean_edge_length(const Mesh& mesh);

}  // namespace triglyph
