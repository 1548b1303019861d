// Attacks that refine the triangles of a surface, one level at a time. Each returns a new mesh.
// They work on the edges of any set of triangles, so that no face is refused; where an edge has
// other than two faces it counts as a border.
#pragma once

#include "engine/mesh/mesh.h"

namespace triglyph {

// Every triangle cut into four at the middles of its sides: the shape stays. O(t log t), parallel.
[[nodiscard]] Mesh subdivided_at_midpoints(const Mesh& mesh);

// The same cut with Loop's smoothing; borders tend to a cubic spline, points where other than two
// borders meet stay.
// Loop. Smooth subdivision surfaces based on triangles. Master's thesis, Utah (1987).
[[nodiscard]] Mesh subdivided_by_loop(const Mesh& mesh);

// A point in the middle of every triangle, every inner edge turned to connect two of them: three
// times as many triangles. Borders are left as they are, points and edges, in every step.
// Kobbelt. sqrt(3)-subdivision. SIGGRAPH (2000), but for the borders, which are split there in
// every second step.
[[nodiscard]] Mesh subdivided_by_sqrt3(const Mesh& mesh);

}  // namespace triglyph
