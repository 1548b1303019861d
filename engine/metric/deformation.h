// Measures of how much a change of positions displaces, stretches and bends a surface. All compare
// two positions of the same triangles. Precondition of all: as many points before as after.
#pragma once

#include <span>

#include "engine/mesh/mesh.h"

namespace triglyph {

// Distances that points moved, in model units.
struct Displacement {
  double max = 0;
  double mean = 0;  // over all points, moved or not
  double rms = 0;   // likewise
};

// Returns how far the points moved. O(points).
[[nodiscard]] Displacement displacement(std::span<const Vec3> before, std::span<const Vec3> after);

// Returns the signal-to-noise ratio in decibels, infinite if nothing moved: 10 log10 of the sum of
// squared distances of the points from their centroid over the sum of squared displacements.
// O(points).
// Usual in work on mesh watermarks, e.g. Cayre, Macq, IEEE Trans. Signal Processing 51(4) (2003).
[[nodiscard]] double signal_to_noise(std::span<const Vec3> before, std::span<const Vec3> after);

// Returns the square root of the mean strain energy density of the faces; dimensionless, 0 for
// rigid motions. A face that is stretched by s and t along its principal directions has the energy
// ((s - 1)^2 + (t - 1)^2) / 2 per unit of its area before, as an elastic membrane of Poisson ratio
// 0. Does not see bending along edges. Degenerate faces are left out. O(faces).
// After Bian, Hu, Martin, Evaluation for small visual difference between conforming meshes on
// strain field, J. Comput. Sci. Technol. 24(1) (2009), with faces weighted by their area only.
[[nodiscard]] double strain(std::span<const Triangle> triangles, std::span<const Vec3> before,
                            std::span<const Vec3> after);

// Angles between the normals of faces before and after, in degrees. The mean is weighted by the
// area before. Faces that are degenerate before or after are left out.
struct NormalDeviation {
  double max = 0;
  double mean = 0;
};
// Returns how far the normals of the faces turned. O(faces).
[[nodiscard]] NormalDeviation normal_deviation(std::span<const Triangle> triangles,
                                               std::span<const Vec3> before,
                                               std::span<const Vec3> after);

}  // namespace triglyph
