// Attacks on how a file lists a shape: order, orientation, and which corners share a point. Each
// returns a changed copy.
#pragma once

#include <cstdint>

#include "engine/mesh/mesh.h"

namespace triglyph {

// New order of points and triangles, and every triangle starts at another corner. O(n log n).
[[nodiscard]] Mesh reordered(const Mesh& mesh, std::uint64_t seed);

// The same surface with every triangle wound the other way: inside out. O(triangles).
[[nodiscard]] Mesh flipped(const Mesh& mesh);

// Every triangle on three points of its own, as STL lists it. Points at equal coordinates, which a
// mesh in memory else never has, are one again as soon as a file is read. O(triangles).
[[nodiscard]] Mesh as_soup(const Mesh& mesh);

// Points closer than `tolerance_rel_diag`, in shares of the box's diagonal, to one that comes
// before them become that one; triangles that thereby repeat a point are gone. O(points) expected.
[[nodiscard]] Mesh welded(const Mesh& mesh, double tolerance_rel_diag);

}  // namespace triglyph
