// How much of a ball, and of its sphere, lies inside a surface, exactly.
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

// Invariants of the ball of `radius` > 0 about `centre`. `triangles` must hold every triangle that
// meets the ball (others do no harm), of a surface that is closed and consistently wound as far as
// the ball sees; several sheets may. Degenerate triangles count nothing. A centre on the surface is
// taken for one just inside. Inside out gives 1 - x.
// O(triangles): a few arc tangents each.
[[nodiscard]] BallInvariants ball_invariants(std::span<const Vec3> positions,
                                             std::span<const Triangle> mesh,
                                             std::span<const std::uint32_t> triangles,
                                             const Vec3& centre, double radius);

// The same about every centre; NaN where the ball meets a triangle marked as unfit (at a boundary,
// say), or more than `most` triangles. `unfit`: one mark a triangle. Parallel, the same for any
// number of threads. `index` of the same triangles. O(centres * triangles a ball).
[[nodiscard]] std::vector<BallInvariants> all_ball_invariants(
    std::span<const Vec3> positions, std::span<const Triangle> mesh, const SpatialIndex& index,
    std::span<const char> unfit, std::span<const Vec3> centres, double radius, std::size_t most);

}  // namespace triglyph
