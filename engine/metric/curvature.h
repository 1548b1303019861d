// Curvature averaged over a neighbourhood.
#pragma once

#include <vector>

#include "engine/mesh/edge_graph.h"
#include "engine/mesh/mesh.h"

namespace triglyph {

// Mean of the absolute principal curvatures at every point, 1 / model unit: eigenvalues of the
// normal cycle's curvature tensor over the edges within `radius` (model units, > 0) of the point
// that hang together with it. 0 for a point no triangle uses; edges without exactly two faces count
// as flat. O(points * edges within the radius), parallel.
// Cohen-Steiner, Morvan, Restricted Delaunay triangulations and normal cycle. SoCG (2003).
[[nodiscard]] std::vector<double> mean_curvatures(const Mesh& mesh, const EdgeGraph& graph,
                                                  double radius);

}  // namespace triglyph
