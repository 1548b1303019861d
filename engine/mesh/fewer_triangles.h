// Simplification of triangle meshes, by meshoptimizer, with which game assets are simplified.
#pragma once

#include <cstddef>
#include <vector>

#include "engine/mesh/mesh.h"

namespace triglyph {

// Both return about `kept` triangles between points of the mesh, or all of them if there are not
// more. O(t log t).

// Collapses edges to one of their ends, in the order of the quadric error (Garland and Heckbert,
// SIGGRAPH 1997). Borders shrink along themselves only. Stops early where every further collapse
// would change the topology.
[[nodiscard]] std::vector<Triangle> collapsed(const Mesh& mesh, std::size_t kept);

// Makes the points of each cell of a grid one of them, so that points are left everywhere alike,
// also where the surface is flat. The result need not be manifold.
[[nodiscard]] std::vector<Triangle> clustered(const Mesh& mesh, std::size_t kept);

}  // namespace triglyph
