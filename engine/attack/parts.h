// Attacks that take a part of a shape away or add one. Each returns a changed copy.
#pragma once

#include <cstdint>

#include "engine/mesh/mesh.h"

namespace triglyph {

// What is left when a plane of random direction cuts off the share of the triangles whose centroids
// lie farthest out, rounded to whole triangles. O(triangles) expected.
[[nodiscard]] Mesh cropped(const Mesh& mesh, double share_removed, std::uint64_t seed);

// The mesh and beside it a bumpy ball with about `share` as many triangles, at least 80, of the
// same mean edge length, which does not touch it: centre, size and mean edge of the whole change.
// O(triangles).
[[nodiscard]] Mesh with_added_ball(const Mesh& mesh, double share, std::uint64_t seed);

}  // namespace triglyph
