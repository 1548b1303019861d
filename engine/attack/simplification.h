// Simplification to a share of the triangles.
#pragma once

#include "engine/mesh/mesh.h"

namespace triglyph {

// Returns the mesh without the share `removed`, 0 to 1, of its triangles: edges are collapsed to
// one of their ends, in the order of the quadric error (Garland and Heckbert, SIGGRAPH 1997), by
// meshoptimizer, with which game assets are simplified. Points that are left keep their coordinates
// to the last bit. Borders shrink along themselves only. It stops early where every further
// collapse would change the topology. O(t log t).
[[nodiscard]] Mesh simplified(const Mesh& mesh, double removed);

}  // namespace triglyph
