// Meshes made from a seed, of any size, for tests, benchmarks and demonstrations: no file needed.
#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/mesh/mesh.h"

namespace triglyph {

enum class SampleShape {
  Closed,     // a bumpy ball
  Open,       // a bumpy sheet with one border
  HighGenus,  // a bumpy slab with square holes in it
};

// An irregular triangulation like that of a scan: jittered points, diagonals drawn by lot, sizes
// that vary smoothly, bumps of several wavelengths; within 10 % of `triangles` many from 80 on.
// Manifold, consistently oriented (outwards where closed), points distinct, about 2 units across.
// The shape is a ball, sheet or slab under a one-to-one map of space, so it does not meet itself
// where the triangles are smaller than the bumps. The slab keeps its edges. note: not a model of
// scanner noise, nor of holes in the data. The result depends on the arguments only. Precondition:
// triangles >= 40, for HighGenus >= 64, and at most 2^32, else std::logic_error. O(triangles).
[[nodiscard]] Mesh make_sample_shape(SampleShape shape, std::size_t triangles, std::uint64_t seed);

// Handles of the shape: 0, or for HighGenus k * k for k between 1 (small meshes) and 5.
[[nodiscard]] std::uint32_t genus_of_sample(SampleShape shape, std::size_t triangles,
                                            std::uint64_t seed);

}  // namespace triglyph
