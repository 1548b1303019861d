// Simplification to a share of the triangles.
#pragma once

#include "engine/mesh/mesh.h"

namespace triglyph {

// Returns the mesh without the share `removed`, 0 to 1, of its triangles; see collapsed(). Points
// that are left keep their coordinates to the last bit. O(t log t).
[[nodiscard]] Mesh simplified(const Mesh& mesh, double removed);

}  // namespace triglyph
