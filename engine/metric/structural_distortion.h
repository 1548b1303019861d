// Perceptual distances, which compare the statistics of curvature in a window around each point:
// changes of curvature are visible on smooth parts of a surface and hardly on rough ones.
// note: the authors' programs only walk outwards, which leaves out some edges of a window, and pair
// samples by the order of their walk. Here a window is the connected piece of surface within its
// radius, and a sample is paired with the same place on the other surface. Values may differ from
// published ones in the second digit.
#pragma once

#include <cstddef>
#include <limits>

#include "engine/mesh/mesh.h"

namespace triglyph {

// Returns the mesh structural distortion measure, from 0 (equal) to 1, between two positions of the
// same triangles. Relative to the longest side D of the first mesh's bounding box, curvature is
// averaged over a radius of 0.005, and windows have a radius of 0.015 and Gaussian weights of
// standard deviation 0.008. The luminance-, contrast- and structure-like terms have the weights
// 0.4, 0.4 and 0.2 and are pooled with exponent 3, over the windows of the first mesh and of the
// second. Precondition: equal sizes. O(points * edges in a window).
// Lavoue, Gelasca, Dupont, Baskurt, Ebrahimi, Perceptually driven 3D distance metrics with
// application to watermarking. SPIE 6312 (2006); terms stabilised as in the authors' program.
[[nodiscard]] double msdm(const Mesh& first, const Mesh& second);

// Returns the multiscale measure, which compares meshes of any connectivity: each point of one mesh
// with the nearest place on the other, at curvature radii of 0.002, 0.003 and 0.004 D and windows
// five times as wide, where D belongs to the mesh whose points are compared. The result is the
// average of both directions. Throws Error Usage if a mesh has no faces. O(points * edges in a
// window); of a mesh of more than `at_most` points the windows about fewer, one in so many, stand
// for all.
// Lavoue, A multiscale metric for 3D mesh visual quality assessment. CGF 30(5) (2011).
[[nodiscard]] double msdm2(const Mesh& first, const Mesh& second,
                           std::size_t at_most = std::numeric_limits<std::size_t>::max());

// So many windows tell the visibility of a mark to some percent: it covers the whole surface.
inline constexpr std::size_t kWindowsSeen = 20'000;

}  // namespace triglyph
