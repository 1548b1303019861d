#include "engine/attack/subdivision.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/base/error.h"
#include "engine/mesh/edge_graph.h"

namespace triglyph {
namespace {

// Finer meshes are refused: their indices would not fit.
constexpr std::size_t kMostTriangles = std::size_t{1} << 28;

void check_size(const Mesh& mesh, std::size_t factor) {
  if (mesh.triangles.size() > kMostTriangles / factor) {
    throw Error(ErrorCode::Unsupported, {}, "",
                std::to_string(mesh.triangles.size()) + " triangles are too many to subdivide");
  }
}

std::uint32_t edge_between(const EdgeGraph& graph, std::uint32_t a, std::uint32_t b) {
  const auto spokes = graph.around(a);
  return std::lower_bound(
             spokes.begin(), spokes.end(), b,
             [](const EdgeGraph::Spoke& spoke, std::uint32_t to) { return spoke.to < to; })
      ->edge;
}

std::uint32_t opposite_corner(const Triangle& t, const Edge& edge) {
  return *std::find_if(t.begin(), t.end(),
                       [&](std::uint32_t p) { return p != edge.from && p != edge.to; });
}

// Point n + e is that of edge e, among n old points.
std::vector<Triangle> quartered(const Mesh& mesh, const EdgeGraph& graph) {
  std::vector<Triangle> triangles;
  triangles.reserve(4 * mesh.triangles.size());
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (const Triangle& t : mesh.triangles) {
    Triangle middle{};
    for (std::size_t i = 0; i < 3; ++i) {
      middle[i] = first + edge_between(graph, t[i], t[(i + 1) % 3]);
    }
    for (std::size_t i = 0; i < 3; ++i) {
      triangles.push_back({t[i], middle[i], middle[(i + 2) % 3]});
    }
    triangles.push_back(middle);
  }
  return triangles;
}

Vec3 loop_edge_point(const Mesh& mesh, const Edge& edge) {
  const Vec3 ends = mesh.positions[edge.from] + mesh.positions[edge.to];
  if (!edge.is_inner()) return ends / 2;
  Vec3 sides(0, 0, 0);
  for (const std::uint32_t face : edge.faces) {
    sides += mesh.positions[opposite_corner(mesh.triangles[face], edge)];
  }
  return 0.375 * ends + 0.125 * sides;
}

// The neighbours of a point, and those of them that a border leads to.
struct Ring {
  Vec3 sum{0, 0, 0};
  double size = 0;
  Vec3 border_sum{0, 0, 0};
  int borders = 0;
};

Ring ring_of(const Mesh& mesh, const EdgeGraph& graph, std::uint32_t point) {
  Ring ring;
  for (const EdgeGraph::Spoke& spoke : graph.around(point)) {
    ring.sum += mesh.positions[spoke.to];
    ring.size += 1;
    if (graph.edges[spoke.edge].is_inner()) continue;
    ring.border_sum += mesh.positions[spoke.to];
    ++ring.borders;
  }
  return ring;
}

Vec3 loop_old_point(const Mesh& mesh, const EdgeGraph& graph, std::uint32_t point) {
  const Vec3& at = mesh.positions[point];
  const Ring ring = ring_of(mesh, graph, point);
  if (ring.borders == 2) return 0.75 * at + 0.125 * ring.border_sum;
  if (ring.borders > 0 || ring.size == 0) return at;
  const double root = 0.375 + 0.25 * std::cos(2 * std::numbers::pi / ring.size);
  const double weight = 0.625 - root * root;  // of all neighbours together
  return (1 - weight) * at + (weight / ring.size) * ring.sum;
}

Vec3 sqrt3_old_point(const Mesh& mesh, const EdgeGraph& graph, std::uint32_t point) {
  const Vec3& at = mesh.positions[point];
  const Ring ring = ring_of(mesh, graph, point);
  if (ring.borders > 0 || ring.size == 0) return at;
  const double weight = (4 - 2 * std::cos(2 * std::numbers::pi / ring.size)) / 9;
  return (1 - weight) * at + (weight / ring.size) * ring.sum;
}

}  // namespace

Mesh subdivided_at_midpoints(const Mesh& mesh) {
  check_size(mesh, 4);
  const EdgeGraph graph = edge_graph(mesh);
  Mesh result{mesh.positions, quartered(mesh, graph)};
  for (const Edge& edge : graph.edges) {
    result.positions.push_back((mesh.positions[edge.from] + mesh.positions[edge.to]) / 2);
  }
  return result;
}

Mesh subdivided_by_loop(const Mesh& mesh) {
  check_size(mesh, 4);
  const EdgeGraph graph = edge_graph(mesh);
  Mesh result{{}, quartered(mesh, graph)};
  for (std::uint32_t i = 0; i < mesh.positions.size(); ++i) {
    result.positions.push_back(loop_old_point(mesh, graph, i));
  }
  for (const Edge& edge : graph.edges) result.positions.push_back(loop_edge_point(mesh, edge));
  return result;
}

Mesh subdivided_by_sqrt3(const Mesh& mesh) {
  check_size(mesh, 3);
  const EdgeGraph graph = edge_graph(mesh);
  Mesh result;
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (std::uint32_t i = 0; i < first; ++i) {
    result.positions.push_back(sqrt3_old_point(mesh, graph, i));
  }
  for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f) {
    const Triangle& t = mesh.triangles[f];
    result.positions.push_back(
        (mesh.positions[t[0]] + mesh.positions[t[1]] + mesh.positions[t[2]]) / 3);
    for (std::size_t i = 0; i < 3; ++i) {
      const Edge& edge = graph.edges[edge_between(graph, t[i], t[(i + 1) % 3])];
      if (!edge.is_inner()) {
        result.triangles.push_back({t[i], t[(i + 1) % 3], first + f});
      } else if (edge.faces[0] == f) {  // once an edge
        const std::uint32_t left = first + f;
        const std::uint32_t right = first + edge.faces[1];
        result.triangles.push_back({edge.from, right, left});
        result.triangles.push_back({edge.to, left, right});
      }
    }
  }
  return result;
}

}  // namespace triglyph
