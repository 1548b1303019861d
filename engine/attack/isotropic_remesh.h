// The surface triangulated anew with edges of one length.
//
// This work is based on:
// Botsch, Kobbelt. A remeshing approach to multiresolution modeling. SGP (2004), section 4; points
// are put back onto the original surface in every round, as in the authors' later book.
#pragma once

#include "engine/mesh/mesh.h"

namespace triglyph {

// Returns the surface with edges between 4/5 and 4/3 of `edge_length` (model units, > 0) for the
// most part: five rounds of splitting long edges, collapsing short ones, turning edges towards six
// at a point, moving points to the middle of their neighbours within the tangent plane, and putting
// them back onto the surface. Borders keep their place; where the surface is not manifold it is cut
// open and counts as a border. Creases are not kept as such. O(r (t + s) log t) for t triangles
// before and s after.
// note: triangles are not turned over by collapses and turns, but may be where the surface is so
// rough that the nearest place on it lies on another sheet.
[[nodiscard]] Mesh remeshed_isotropically(const Mesh& mesh, double edge_length);

}  // namespace triglyph
