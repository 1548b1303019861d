// Collusion: several copies of one mesh, each with the mark of another recipient, become one.
//
// This work is based on:
// Wu, Trappe, Wang, Liu. Collusion-resistant fingerprinting for multimedia. IEEE Signal Processing
// Magazine 21 (2004).
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "engine/mesh/mesh.h"

namespace triglyph {

struct CollusionKind {
  std::string_view name;
  std::string_view help;  // what becomes of the copies, a noun phrase
  Mesh (*combine)(std::span<const Mesh> copies, std::uint64_t seed) = nullptr;
};

// Returns all kinds, in the order of help: "average", "majority", "minimum", "maximum", "pick",
// "mix".
[[nodiscard]] std::span<const CollusionKind> collusion_kinds();

// Returns the kind of a name. Throws Error Usage, with what may be meant, for an unknown one.
[[nodiscard]] const CollusionKind& collusion_kind(std::string_view name);

// Returns what the copies become, a function of them and of the seed alone. Copies may number their
// points differently, as after welding: corners of triangles at the same place in their lists are
// the same point. Throws Error Usage for fewer than two copies, and for copies of different meshes,
// naming the first that differs by its number from 1. O(points + triangles) for each copy.
[[nodiscard]] Mesh colluded(std::span<const Mesh> copies, const CollusionKind& kind,
                            std::uint64_t seed);

}  // namespace triglyph
