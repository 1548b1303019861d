// The point of one surface that is farthest from another, with a certified error: branch and bound
// over triangles.
//
// The distance to a triangle is a convex function of the point, and so is a weighted mean of the
// distances to several triangles, which is never below the least of them. On a piece of the
// surface, the distance to the other surface is therefore at most the greatest value of such a mean
// at the corners of the piece, for any weights. The bound uses the triangles nearest to the corners
// and to the middle; the best weights solve a matrix game. On a piece that spans two nearest
// triangles, the bound is then accurate to second order in the size of the piece.
//
// This work is based on:
// Tang, Lee, Kim. Interactive Hausdorff distance computation for general polygonal models.
// ACM TOG 28(3) (2009), which bounds pieces by single triangles; the means are ours.
#pragma once

#include <array>
#include <limits>
#include <span>

#include "engine/geometry/spatial_index.h"
#include "engine/mesh/mesh.h"

namespace triglyph {

// The farthest point found, and a bound on how much farther any other can be: the true distance
// lies in [distance, distance + error], up to the rounding of coordinates. Model units.
struct FarthestPoint {
  double distance = 0;
  double error = 0;
  Vec3 at{0, 0, 0};
};

struct FarthestQuery {
  // The error at which the search stops; model units, > 0 unless the distance is attained at a
  // corner. It is reached unless `most_splits` stops the search first.
  double tolerance = 0;
  // The number of pieces that are split at most, which bounds time and memory.
  std::size_t most_splits = std::size_t{1} << 22;
};

// Returns the point of the triangles `here` that is farthest from `surface`, the index of the other
// surface, which has at least one triangle. `reach` holds a known upper bound of the distance for
// every triangle of `here`, or infinity. The result is bitwise equal for any number of threads. O(t
// log t) for t triangles whose bound is large; more if the distance is near its maximum along long
// lines on which the nearest triangle changes.
[[nodiscard]] FarthestPoint farthest_point(std::span<const Vec3> positions,
                                           std::span<const Triangle> here,
                                           std::span<const double> reach,
                                           const SpatialIndex& surface, const FarthestQuery& query);

// Returns the least value, over all weighted means of the columns, of the greatest entry of the
// mean: the value of a matrix game. Precondition: at least one column. O(columns^3).
[[nodiscard]] double least_greatest_mean(std::span<const std::array<double, 3>> columns);

}  // namespace triglyph
