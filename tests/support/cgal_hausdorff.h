// The same distance by an independent implementation.
#pragma once

#include "engine/mesh/mesh.h"

namespace triglyph::test {

// Symmetric Hausdorff distance by CGAL (Polygon_mesh_processing), with an error of at most
// `tolerance`, model units. On one thread. Precondition: both meshes are manifold.
[[nodiscard]] double cgal_hausdorff(const Mesh& first, const Mesh& second, double tolerance);

}  // namespace triglyph::test
