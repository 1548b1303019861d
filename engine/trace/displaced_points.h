// The layer of last resort, for meshes with a few points: every point is displaced a little by a
// vector that only key and name know. It is read with the original.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "engine/mesh/mesh.h"
#include "engine/trace/score_table.h"

namespace triglyph {

// Each coordinate of a point is a symbol of 2^kPointBits displacements, from -1 to 1.
inline constexpr int kPointBits = 6;

// Returns the points that stay where they are, by which a reader tells how the mesh was moved:
// up to four, far from each other. Ascending. O(points).
[[nodiscard]] std::vector<std::uint32_t> fixed_points(std::span<const Vec3> positions);

// Returns the positions with every point but the fixed ones displaced for a name by `farthest`,
// model units, at most, along each axis.
[[nodiscard]] std::vector<Vec3> displaced(std::span<const Vec3> positions, double farthest,
                                          const FingerprintCode& code, FingerprintSeed seed);

// Returns tables of what is seen of the displacements: `seen[i]` is where point i of the original
// is in a suspect that was brought to its place, nothing where it is not there. One table for each
// of several sizes of what disturbed the points, with the priors of these and of `ways` ways in
// which the suspect was brought to its place.
[[nodiscard]] std::vector<ScoreTable> score_points(std::span<const Vec3> original,
                                                   std::span<const std::optional<Vec3>> seen,
                                                   double farthest, int ways);

}  // namespace triglyph
