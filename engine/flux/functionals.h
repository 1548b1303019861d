// The functionals that carry a flux mark: the flux, through the surface of a solid, of radial
// fields in soft shells and soft octants about its centre. An integral over the surface does not
// know how the surface is triangulated, and an odd one, in which the normal enters once, does not
// feel noise that inflates the area.
//
// This work is based on the radial methods of
// Cho, Prost, Jung. An oblivious watermarking for 3-D polygonal meshes using distribution of vertex
// norms. IEEE Transactions on Signal Processing 55 (2007), and
// Rolland-Neviere, Doerr, Alliez. Triangle surface mesh watermarking based on a constrained
// optimization framework. IEEE Transactions on Information Forensics and Security 9 (2014),
// of which it is a continuous, oriented form.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/flux/solid_frame.h"

namespace triglyph {

inline constexpr std::size_t kShells = 20;
inline constexpr std::size_t kOctants = 8;
inline constexpr std::size_t kFunctionals = kShells * kOctants;

// Distance of neighbouring shells, and half their width, in units of the frame's scale. Thinner
// shells carry more bits and feel noise and smoothing more.
inline constexpr double kShellWidth = 0.14;

// One value a functional: shell * kOctants + octant. Shells and octants are numbered absolutely, so
// that a reader need not know which of them a mark uses. Bit a of an octant is set on the negative
// side of axis a.
using FluxVector = std::array<double, kFunctionals>;

struct FluxValues {
  FluxVector flux{};    // integral of chi W (u . n), times the shells' half width
  FluxVector weight{};  // integral of chi W: the surface that belongs to the functional
};

// Returns the functionals of a closed surface, in units of the frame. Triangles are cut until they
// are small beside a shell. O(triangles), parallel.
[[nodiscard]] FluxValues flux_values(std::span<const Vec3> positions,
                                     std::span<const Triangle> triangles, const SolidFrame& frame);

// The derivatives of the fluxes in compressed rows, one row a point.
struct FluxDerivatives {
  struct Entry {
    std::uint32_t functional = 0;
    float value = 0;  // per model unit of move along the point's direction
  };
  std::vector<std::size_t> offsets;
  std::vector<Entry> entries;

  [[nodiscard]] std::span<const Entry> at(std::size_t point) const {
    return {entries.data() + offsets[point], entries.data() + offsets[point + 1]};
  }
};

// Returns the derivatives of flux_values().flux when the first points move along `directions`, in a
// frame that stays. O(triangles), parallel.
[[nodiscard]] FluxDerivatives flux_derivatives(std::span<const Vec3> positions,
                                               std::span<const Triangle> triangles,
                                               const PointFaces& faces,
                                               std::span<const Vec3> directions,
                                               const SolidFrame& frame);

}  // namespace triglyph
