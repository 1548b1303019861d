#include "engine/mesh/edge_graph.h"

#include <algorithm>
#include <tuple>

#include "engine/base/parallel.h"

namespace triglyph {
namespace {

// A side of a triangle.
struct Side {
  std::uint32_t low, high, face;
  bool runs_up;  // from low to high

  bool operator<(const Side& other) const {
    return std::tie(low, high, face, runs_up) <
           std::tie(other.low, other.high, other.face, other.runs_up);
  }
  [[nodiscard]] bool is_along(const Side& other) const {
    return low == other.low && high == other.high;
  }
};

std::vector<Side> sorted_sides(const Mesh& mesh) {
  std::vector<Side> sides(3 * mesh.triangles.size());
  parallel_for(
      mesh.triangles.size(),
      [&](std::size_t t) {
        const Triangle& triangle = mesh.triangles[t];
        for (std::size_t i = 0; i < 3; ++i) {
          const std::uint32_t a = triangle[i];
          const std::uint32_t b = triangle[(i + 1) % 3];
          sides[3 * t + i] = {std::min(a, b), std::max(a, b), static_cast<std::uint32_t>(t), a < b};
        }
      },
      kBlock);
  parallel_sort(sides.begin(), sides.end(), std::less<>());
  return sides;
}

Edge edge_of(std::span<const Side> sides) {
  Edge edge{sides[0].low, sides[0].high};
  if (sides.size() == 2 && sides[0].runs_up != sides[1].runs_up) {
    edge.faces = {sides[sides[0].runs_up ? 0 : 1].face, sides[sides[0].runs_up ? 1 : 0].face};
  }
  return edge;
}

}  // namespace

EdgeGraph edge_graph(const Mesh& mesh) {
  const std::vector<Side> sides = sorted_sides(mesh);
  EdgeGraph graph;
  for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    while (end < sides.size() && sides[end].is_along(sides[begin])) ++end;
    graph.edges.push_back(edge_of({sides.data() + begin, sides.data() + end}));
  }
  graph.offsets.assign(mesh.positions.size() + 1, 0);
  for (const Edge& edge : graph.edges) {
    ++graph.offsets[edge.from + 1];
    ++graph.offsets[edge.to + 1];
  }
  for (std::size_t p = 0; p < mesh.positions.size(); ++p) graph.offsets[p + 1] += graph.offsets[p];
  graph.spokes.resize(2 * graph.edges.size());
  std::vector<std::uint32_t> next(graph.offsets.begin(), graph.offsets.end() - 1);
  for (std::uint32_t e = 0; e < graph.edges.size(); ++e) {
    const Edge& edge = graph.edges[e];
    graph.spokes[next[edge.from]++] = {edge.to, e};
    graph.spokes[next[edge.to]++] = {edge.from, e};
  }
  return graph;
}

}  // namespace triglyph
