// The shares of a ball and of its sphere that lie inside a surface, exactly.
// Pottmann, Wallner, Huang, Yang. Integral invariants for robust geometry processing. CAGD 26
// (2009); Wang, Hu. Optimization approach for 3D model watermarking by linear binary programming.
// CAGD 27 (2010). The closed form for triangle meshes is ours, see docs/schemes.md.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/geometry/spatial_index.h"
#include "engine/mesh/mesh.h"

namespace triglyph {

struct BallInvariants {
  double area = 0;    // share of the sphere that lies inside, 0..1; 1/2 on a plane
  double volume = 0;  // share of the ball that lies inside, 0..1; 1/2 on a plane
};

// Returns the invariants of the ball of `radius` > 0, model units, about `centre`. `triangles` must
// name every triangle that meets the ball; others do no harm. As far as the ball reaches, the
// surface must be closed and consistently wound; several sheets may pass through the ball.
// Degenerate triangles do not count. A centre on the surface counts as inside. A surface turned
// inside out gives 1 - x in place of x. O(triangles), a few arc tangents each.
[[nodiscard]] BallInvariants ball_invariants(std::span<const Vec3> positions,
                                             std::span<const Triangle> mesh,
                                             std::span<const std::uint32_t> triangles,
                                             const Vec3& centre, double radius);

// Returns the invariants of the balls about all centres; NaN where a ball meets an unfit triangle
// (at a boundary, say) or more than `most` triangles. `unfit` holds a mark for each triangle, and
// `index` is of the same triangles. Parallel; the result does not depend on the number of threads.
// O(centres * triangles a ball).
[[nodiscard]] std::vector<BallInvariants> all_ball_invariants(
    std::span<const Vec3> positions, std::span<const Triangle> mesh, const SpatialIndex& index,
    std::span<const char> unfit, std::span<const Vec3> centres, double radius, std::size_t most);

}  // namespace triglyph
