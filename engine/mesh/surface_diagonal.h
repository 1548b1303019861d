// The size of a mesh to which moves and distances are related.
#pragma once

#include "engine/mesh/mesh.h"

namespace triglyph {

// Returns the length of the diagonal of the bounding box of the points that triangles use, in model
// units; 0 without triangles. Stray points, which no triangle uses, do not count: nobody sees them.
// O(triangles), parallel.
[[nodiscard]] double surface_diagonal(const Mesh& mesh);

}  // namespace triglyph
