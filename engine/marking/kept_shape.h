// What an owner keeps of a mesh, in some ten kilobytes, so that the flux layer of a piece of a copy
// can be read when the mesh itself is not at hand.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/flux/flux_embedding.h"
#include "engine/mesh/mesh.h"
#include "engine/mesh/surface.h"

namespace triglyph {

struct KeptShape {
  FluxSolid solid;  // of the mesh
  Mesh coarse;      // some of its points, rounded to 2^-16 of the longest side, and a surface
  std::vector<std::uint64_t> landmarks;  // of points of `coarse`; 0: none is known. See landmarks()

  // Returns that of a mesh; nothing for one that can have no flux layer. O(t log t).
  [[nodiscard]] static std::optional<KeptShape> of(const Surface& surface);

  [[nodiscard]] std::vector<char> bytes() const;
  // Returns the shape with these bytes(); nothing for others.
  [[nodiscard]] static std::optional<KeptShape> from_bytes(std::span<const char> bytes);
};

}  // namespace triglyph
