// How much a surface was bent, stretched and displaced by a change of its points: measures of two
// positions of the same triangles. Precondition of all: as many points before as after.
#pragma once

#include <span>

#include "engine/mesh/mesh.h"

namespace triglyph {

// Of points, model units.
struct Displacement {
  double max = 0;
  double mean = 0;  // over all points, moved or not
  double rms = 0;   // likewise
};
// O(points).
[[nodiscard]] Displacement displacement(std::span<const Vec3> before, std::span<const Vec3> after);

// 10 log10 of the summed squares of the points, about their centroid, over those of the
// displacements; decibel, infinite if nothing moved. Sum order is fixed. O(points).
// Usual in work on mesh watermarks, e.g. Cayre, Macq, IEEE Trans. Signal Processing 51(4) (2003).
[[nodiscard]] double signal_to_noise(std::span<const Vec3> before, std::span<const Vec3> after);

// Square root of the mean strain energy density of the faces, dimensionless, 0 for rigid motions:
// where a face is stretched by s and t along its principal directions, the energy is
// ((s - 1)^2 + (t - 1)^2) / 2 a unit of area before (an elastic membrane of Poisson ratio 0). Blind
// to bending along edges. Degenerate faces count nothing. O(faces). After Bian, Hu, Martin,
// Evaluation for small visual difference between conforming meshes on strain field, J. Comput. Sci.
// Technol. 24(1) (2009), with all faces weighing by their area only.
[[nodiscard]] double strain(std::span<const Triangle> triangles, std::span<const Vec3> before,
                            std::span<const Vec3> after);

// Angles between a face's normals before and after, degrees; the mean is weighted by area before.
// Faces degenerate before or after count nothing. O(faces).
struct NormalDeviation {
  double max = 0;
  double mean = 0;
};
[[nodiscard]] NormalDeviation normal_deviation(std::span<const Triangle> triangles,
                                               std::span<const Vec3> before,
                                               std::span<const Vec3> after);

}  // namespace triglyph
