// Discrete curvature, averaged over a neighbourhood.
#pragma once

#include <vector>

#include "engine/mesh/edge_graph.h"
#include "engine/mesh/mesh.h"

namespace triglyph {

// Returns the mean of the absolute principal curvatures at every point, in 1 / model unit. They are
// eigenvalues of the normal cycle's curvature tensor over the edges that lie within `radius` (model
// units, > 0) of the point and are connected to it there. Edges without exactly two faces count as
// flat; points without faces get 0. O(points * edges within the radius), parallel.
// Cohen-Steiner, Morvan, Restricted Delaunay triangulations and normal cycle. SoCG (2003).
[[nodiscard]] std::vector<double> mean_curvatures(const Mesh& mesh, const EdgeGraph& graph,
                                                  double radius);

}  // namespace triglyph
