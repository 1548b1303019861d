// The edges and point neighbourhoods of any set of triangles, manifold or not; surface walks use
// it.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/mesh/mesh.h"

namespace triglyph {

inline constexpr std::uint32_t kNoFace = 0xffffffff;

struct Edge {
  std::uint32_t from = 0;  // the lower point index
  std::uint32_t to = 0;
  // The face that traverses the edge from `from` to `to`, and the face that traverses it backwards.
  // Both are kNoFace unless the edge has exactly these two faces; it is then a boundary edge or not
  // manifold.
  std::array<std::uint32_t, 2> faces{kNoFace, kNoFace};

  [[nodiscard]] bool is_inner() const { return faces[0] != kNoFace; }
};

// Edges in compressed rows by point.
struct EdgeGraph {
  struct Spoke {
    std::uint32_t to = 0;    // the neighbour
    std::uint32_t edge = 0;  // index in `edges`
  };
  std::vector<Edge> edges;  // ascending by (from, to)
  std::vector<std::uint32_t> offsets;
  std::vector<Spoke> spokes;

  // Returns the edges at a point, by ascending neighbour.
  [[nodiscard]] std::span<const Spoke> around(std::uint32_t point) const {
    return {spokes.data() + offsets[point], spokes.data() + offsets[point + 1]};
  }
};

// Returns the graph of all edges of the mesh. Precondition: at most 2^31 edges. O(t log t),
// parallel.
[[nodiscard]] EdgeGraph edge_graph(const Mesh& mesh);

}  // namespace triglyph
