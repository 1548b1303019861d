// The point of one surface that is farthest from another, with proof: branch and bound over
// triangles.
//
// The distance to a triangle is a convex function, and so is any weighted mean of distances to
// several triangles, which is never below the least of them. So on a piece of the surface the
// distance is nowhere greater than the greatest such mean at the piece's corners, whatever the
// weights. The triangles are those nearest to the corners and to the middle; the best weights solve
// a matrix game. A piece that crosses from one nearest triangle to the next is thus bounded to
// second order of its size.
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

// The farthest point found, and how much farther any other can be: the true distance lies in
// [distance, distance + error], up to rounding of coordinates. Model units.
struct FarthestPoint {
  double distance = 0;
  double error = 0;
  Vec3 at{0, 0, 0};
};

struct FarthestQuery {
  // Stop as soon as the error is no greater; model units, > 0 unless the distance is attained at
  // corners. Met unless the splits run out.
  double tolerance = 0;
  // So many pieces are split at most, which bounds time and memory.
  std::size_t most_splits = std::size_t{1} << 22;
};

// `surface`: index of the triangles `there` of the other surface, of which there is at least one.
// `reach`: known bounds of the distance, one a triangle of `here`; infinity where there is none.
// Bitwise the same for any number of threads. O(t log t) for t triangles that reach far, and more
// the longer the lines are along which the distance is greatest and the nearest place changes.
[[nodiscard]] FarthestPoint farthest_point(std::span<const Vec3> positions,
                                           std::span<const Triangle> here,
                                           std::span<const double> reach,
                                           const SpatialIndex& surface, const FarthestQuery& query);

// The least, over weighted means of the columns, of a mean's greatest entry: the value of a matrix
// game. Precondition: at least one column. O(columns^3).
[[nodiscard]] double least_greatest_mean(std::span<const std::array<double, 3>> columns);

}  // namespace triglyph
