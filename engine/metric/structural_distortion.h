// Perceptual distances: how much the statistics of curvature differ in a window about each point.
// People see changes of curvature on smooth parts, and hardly any on rough ones.
// note: the authors' programs walk outwards only, so they leave out some edges of a window, and
// pair samples by the order of their walk; here a window is the whole piece of surface within its
// radius, and a sample is paired with the same place of the other surface. Values may differ from
// published ones in the second digit.
#pragma once

#include "engine/mesh/mesh.h"

namespace triglyph {

// Mesh structural distortion measure, 0 (equal) to 1, between two positions of the same triangles.
// In units of the longest side D of the first mesh's box: curvature over a radius of 0.005, windows
// of radius 0.015 with Gaussian weights of deviation 0.008; luminance-, contrast- and
// structure-like terms weigh 0.4, 0.4, 0.2 and are pooled with exponent 3, over windows of the
// first mesh and of the second. Precondition: equal sizes. O(points * edges in a window).
// Lavoue, Gelasca, Dupont, Baskurt, Ebrahimi, Perceptually driven 3D distance metrics with
// application to watermarking. SPIE 6312 (2006); terms stabilised as in the authors' program.
[[nodiscard]] double msdm(const Mesh& first, const Mesh& second);

// Multiscale: each point of one mesh against the nearest place of the other, any two
// tessellations, at curvature radii of 0.002, 0.003 and 0.004 D with windows five times as wide,
// D of the mesh whose points are compared; the average of both directions. Throws Error Usage if a
// mesh has no faces. O(points * edges in a window).
// Lavoue, A multiscale metric for 3D mesh visual quality assessment. CGF 30(5) (2011).
[[nodiscard]] double msdm2(const Mesh& first, const Mesh& second);

}  // namespace triglyph
