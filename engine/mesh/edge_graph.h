// The edges of any triangles, found from their points: what walks over a surface use.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/mesh/mesh.h"

namespace triglyph {

inline constexpr std::uint32_t kNoFace = 0xffffffff;

struct Edge {
  std::uint32_t from = 0;  // the lower point
  std::uint32_t to = 0;
  // The triangle that runs along the edge from `from` to `to`, and the one that runs back. kNoFace
  // twice if there are not exactly these two: the edge is a boundary or not manifold.
  std::array<std::uint32_t, 2> faces{kNoFace, kNoFace};

  [[nodiscard]] bool is_inner() const { return faces[0] != kNoFace; }
};

struct EdgeGraph {
  struct Spoke {
    std::uint32_t to = 0;    // the neighbour
    std::uint32_t edge = 0;  // index in `edges`
  };
  std::vector<Edge> edges;  // ascending by points
  std::vector<std::uint32_t> offsets;
  std::vector<Spoke> spokes;

  [[nodiscard]] std::span<const Spoke> around(std::uint32_t point) const {
    return {spokes.data() + offsets[point], spokes.data() + offsets[point + 1]};
  }
};

// Precondition: at most 2^31 edges. O(t log t), parallel.
[[nodiscard]] EdgeGraph edge_graph(const Mesh& mesh);

}  // namespace triglyph
