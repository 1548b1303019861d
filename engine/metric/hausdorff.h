// How far two surfaces are from each other, sampled at points, edge midpoints and centroids of
// their triangles; distances from a sample to a surface are exact (Embree prunes, double decides).
// note: a lower bound of the true Hausdorff distance, which may be attained between samples.
#pragma once

#include <span>

#include "engine/mesh/mesh.h"

namespace triglyph {

// All in model units.
struct HausdorffDistance {
  double forward = 0;   // farthest sample of the first surface from the second
  double backward = 0;  // and the other way round

  [[nodiscard]] double symmetric() const { return forward > backward ? forward : backward; }
};

// Between two positions of the same triangles. Triangles that did not move count nothing, and a
// sample is skipped once its own displacement proves it no farther than the farthest yet.
// Precondition: equal sizes. O(m log t) for m triangles that moved.
[[nodiscard]] HausdorffDistance hausdorff_of_move(std::span<const Triangle> triangles,
                                                  std::span<const Vec3> before,
                                                  std::span<const Vec3> after);

// Between any two meshes; a point no triangle uses does not count. Throws Error Usage if either has
// no triangles. O((s + t) log (s + t)).
[[nodiscard]] HausdorffDistance hausdorff(const Mesh& first, const Mesh& second);

// Vertex displacements between two positions of the same points, model units.
struct Displacement {
  double max = 0;
  double rms = 0;  // over all points, moved or not
};
[[nodiscard]] Displacement displacement(std::span<const Vec3> before, std::span<const Vec3> after);

// Length of the diagonal of the axis-parallel box around the points; 0 for none.
[[nodiscard]] double box_diagonal(std::span<const Vec3> points);

}  // namespace triglyph
