// Registration: how a suspect, or a piece of it, was moved away from the original.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/align/similarity.h"
#include "engine/mesh/mesh.h"

namespace triglyph {

struct Alignment {
  Similarity motion;   // from the suspect to the original
  double overlap = 0;  // the share of the suspect's points that come close to the original
  double rms = 0;      // distance of these, model units of the original
};

// Returns a number for each point by which it is found in other meshes: it depends on how its
// surroundings are connected, and is 0 if another point has the same. O(triangles).
[[nodiscard]] std::vector<std::uint64_t> landmarks(const Mesh& mesh);

// Returns the similarities, mirror images among them, that bring the suspect to the original, at
// most four, the best first: several of a shape that is symmetric; none if less than half of its
// points come within a hundredth of the original's diagonal. Tries the suspect as it is; points
// whose surroundings are connected as in the original and nowhere else in it, which finds pieces
// that were cut out, whatever happened to the shape; and the principal axes, which finds whole
// shapes, however they are triangulated. A piece of which the connectivity has changed as well is
// found only where it has not been moved. Then moves the suspect closer, point to plane.
// Deterministic for any number of threads. O(points log points), parallel.
//
// This work is based on:
// Chen, Medioni. Object modelling by registration of multiple range images. Image and Vision
// Computing 10 (1992).
// Chetverikov, Svirko, Stepanov, Krsek. The trimmed iterative closest point algorithm. ICPR (2002).
[[nodiscard]] std::vector<Alignment> align(const Mesh& suspect, const Mesh& original);

// Likewise, with an original that is simplified: `marks` are the numbers that its points had before
// as landmarks(), one for each, 0 where none is known.
[[nodiscard]] std::vector<Alignment> align(const Mesh& suspect, const Mesh& original,
                                           std::span<const std::uint64_t> marks);

// Returns the similarities, mirror images among them, that bring some of the points closest to the
// targets, four or fewer, at most `most` of them, the closest first. Tries every choice of points
// whose distances have the ratios of the targets' to a hundredth: O(points^4) at worst, for few
// points. Nothing for fewer than three targets.
[[nodiscard]] std::vector<Similarity> ways_onto(std::span<const Vec3> points,
                                                std::span<const Vec3> targets, std::size_t most);

// Returns where each point of the original has gone along its normal: where the suspect, moved,
// comes within `reach` (model units) of it, straight above or below; nothing where it does not, as
// where a piece was cut off. O(points log triangles), parallel.
[[nodiscard]] std::vector<std::optional<Vec3>> places_on(const Mesh& original, const Mesh& suspect,
                                                         const Similarity& motion, double reach);

// Returns the point of the suspect, moved, that is the nearest to each point of the original within
// `reach`; nothing where there is none. O(points * suspect's points).
[[nodiscard]] std::vector<std::optional<Vec3>> nearest_points(const Mesh& original,
                                                              const Mesh& suspect,
                                                              const Similarity& motion,
                                                              double reach);

}  // namespace triglyph
