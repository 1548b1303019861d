// Attacks that move points and leave the triangles as they are. Each returns a changed copy; those
// that draw lots are functions of the seed.
//
// This work is based on:
// Wang, Lavoue, Denis, Baskurt, He. A benchmark for 3D mesh watermarking. SMI (2010), whose
// conventions noise, smoothing and quantisation follow.
#pragma once

#include <cstdint>

#include "engine/mesh/mesh.h"
#include "engine/mesh/uniform_flow.h"

namespace triglyph {

// Every coordinate shifted by up to `intensity` times the mean distance of the points from their
// centroid, uniformly: the benchmark's noise. O(points).
[[nodiscard]] Mesh with_uniform_noise(const Mesh& mesh, double intensity, std::uint64_t seed);

// Laplacian smoothing with uniform weights: in each round every point, on a border too, moves by
// `step` of the way to the mean of its neighbours, all at once. O(rounds * edges), parallel.
[[nodiscard]] Mesh smoothed(const Mesh& mesh, int rounds, double step = kFlowStep);

// Coordinates rounded to multiples of 2^-bits of the box's side, an axis at a time, from its lower
// end: the benchmark's quantisation, with 2^bits intervals and therefore 2^bits + 1 values.
// O(points).
[[nodiscard]] Mesh quantised(const Mesh& mesh, int bits);

// Coordinates rounded to a grid of one width for all axes, of which the box's longest side has
// 2^bits - 1: what Draco, glTF's and other compressed formats do. O(points).
[[nodiscard]] Mesh quantised_to_cubes(const Mesh& mesh, int bits);

// Coordinates as "%.{digits}g" would write them. O(points).
[[nodiscard]] Vec3 with_significant_digits(const Vec3& point, int digits);
[[nodiscard]] Mesh with_significant_digits(const Mesh& mesh, int digits);

// Coordinates as half floats (IEEE binary16) hold them, once the box lies about the origin with a
// longest side of 2, as it does in formats for display. O(points).
[[nodiscard]] Mesh as_half_floats(const Mesh& mesh);

}  // namespace triglyph
