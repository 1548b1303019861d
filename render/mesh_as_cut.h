// Meshes of files with polygons, cut alike so that they can be compared.
#pragma once

#include "engine/io/mesh_file.h"

namespace triglyph {

// Returns the mesh of `marked`, cut into the triangles of `original` if both have the same
// polygons: how these are cut depends on where the points lie, and pictures show what points moved.
// Otherwise the mesh as it is. O(corners).
[[nodiscard]] Mesh mesh_as_cut_in(const MeshFile& original, const MeshFile& marked);

}  // namespace triglyph
