#include "engine/metric/curvature.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/base/parallel.h"
#include "engine/geometry/symmetric_matrix.h"
#include "engine/metric/surface_walk.h"

namespace triglyph {
namespace {

Vec3 normal_of(const Mesh& mesh, std::uint32_t face) {
  return area_normal(mesh.positions, mesh.triangles[face]);
}

// Returns the signed dihedral angle of every edge in radians, > 0 if the edge is convex.
std::vector<double> dihedral_angles(const Mesh& mesh, const EdgeGraph& graph) {
  std::vector<double> angles(graph.edges.size(), 0);
  parallel_for(
      graph.edges.size(),
      [&](std::size_t e) {
        const Edge& edge = graph.edges[e];
        if (!edge.is_inner()) return;
        const Vec3 left = normal_of(mesh, edge.faces[0]);
        const Vec3 right = normal_of(mesh, edge.faces[1]);
        const Vec3 along = mesh.positions[edge.to] - mesh.positions[edge.from];
        const double length = along.norm();
        if (!(length > 0)) return;
        angles[e] = std::atan2(dot(cross(left, right), along) / length, dot(left, right));
      },
      kBlock);
  return angles;
}

double mean_of_principal(const SymmetricMatrix& tensor) {
  std::array<double, 3> sizes = tensor.principal_axes().values;
  for (double& size : sizes) size = std::abs(size);
  std::sort(sizes.begin(), sizes.end());
  return (sizes[1] + sizes[2]) / 2;  // the least eigenvalue is that of the normal
}

}  // namespace

std::vector<double> mean_curvatures(const Mesh& mesh, const EdgeGraph& graph, double radius) {
  const std::vector<double> angles = dihedral_angles(mesh, graph);
  std::vector<double> curvatures(mesh.positions.size());
  parallel_walks(mesh.positions, graph, [&](SurfaceWalk& walk, std::uint32_t point) {
    SymmetricMatrix tensor;
    walk.visit(point, radius,
               [&](std::uint32_t from, const EdgeGraph::Spoke& spoke, double share, bool) {
                 const Vec3 along = mesh.positions[spoke.to] - mesh.positions[from];
                 const double length = along.norm();
                 if (length > 0) tensor.add(along, angles[spoke.edge] * share / length);
               });
    curvatures[point] = mean_of_principal(tensor) / (M_PI * radius * radius);
  });
  return curvatures;
}

}  // namespace triglyph
