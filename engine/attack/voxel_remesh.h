// The surface made anew from a grid of voxels, which forgets the tessellation altogether.
//
// This work is based on:
// Nooruddin, Turk. Simplification and repair of polygonal models using volumetric techniques. IEEE
// TVCG 9(2) (2003): inside is what most of three directions of rays find to be inside.
// Gibson. Constrained elastic surface nets. MICCAI (1998), without the relaxation.
#pragma once

#include "engine/mesh/mesh.h"

namespace triglyph {

// Returns the border of the solid that the mesh encloses, on a grid with `voxels` along the box's
// longest side: a point in every voxel that the border passes, at the mean of the places where the
// mesh cuts the voxel's edges. Parts that overlap become one. A ray that enters as often as it
// leaves tells inside from outside; where a hole makes the others disagree they do not count, so
// that small holes are closed, and a surface that encloses nothing is lost. Precondition: 2 <=
// voxels
// <= 512. O(triangles + voxels^3).
// note: sharp edges are rounded by up to a voxel, and two sheets in one voxel touch.
[[nodiscard]] Mesh remeshed_by_voxels(const Mesh& mesh, int voxels);

}  // namespace triglyph
