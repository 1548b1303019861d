#include "engine/metric/roughness.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "engine/base/parallel.h"
#include "engine/mesh/edge_graph.h"
#include "engine/mesh/point_faces.h"

namespace triglyph {
namespace {

// The properties of faces that roughness depends on.
struct Faces {
  std::vector<double> areas;
  std::vector<double> bends;  // mean of 1 - cos of the angles to the neighbours
  PointFaces of_points;
};

Faces faces_of(const Mesh& mesh) {
  Faces faces;
  std::vector<Vec3> normals(mesh.triangles.size());
  faces.areas.resize(mesh.triangles.size());
  for (std::size_t t = 0; t < normals.size(); ++t) {
    const Vec3 normal = area_normal(mesh.positions, mesh.triangles[t]);
    faces.areas[t] = normal.norm() / 2;
    normals[t] = faces.areas[t] > 0 ? normal / normal.norm() : Vec3(0, 0, 0);
  }
  std::vector<std::uint32_t> neighbours(mesh.triangles.size(), 0);
  faces.bends.assign(mesh.triangles.size(), 0);
  for (const Edge& edge : edge_graph(mesh).edges) {
    if (!edge.is_inner()) continue;
    const double bend = 1 - dot(normals[edge.faces[0]], normals[edge.faces[1]]);
    for (const std::uint32_t face : edge.faces) {
      faces.bends[face] += bend;
      ++neighbours[face];
    }
  }
  for (std::size_t t = 0; t < neighbours.size(); ++t) {
    faces.bends[t] /= std::max(1U, neighbours[t]);
  }
  faces.of_points = point_faces(mesh);
  return faces;
}

// Returns the faces that share a point with these, including these, ascending.
std::vector<std::uint32_t> one_ring_more(const Mesh& mesh, const Faces& faces,
                                         std::span<const std::uint32_t> ring) {
  std::vector<std::uint32_t> wider;
  for (const std::uint32_t face : ring) {
    for (const std::uint32_t point : mesh.triangles[face]) {
      const auto more = faces.of_points.at(point);
      wider.insert(wider.end(), more.begin(), more.end());
    }
  }
  std::sort(wider.begin(), wider.end());
  wider.erase(std::unique(wider.begin(), wider.end()), wider.end());
  return wider;
}

// Returns the mean times the variance of the bends, per unit of area.
double roughness_of(const Faces& faces, std::span<const std::uint32_t> ring) {
  double area = 0, sum = 0, squares = 0;
  for (const std::uint32_t face : ring) {
    area += faces.areas[face];
    sum += faces.bends[face];
    squares += faces.bends[face] * faces.bends[face];
  }
  if (!(area > 0)) return 0;
  const auto count = static_cast<double>(ring.size());
  const double mean = sum / count;
  return mean * std::max(0.0, squares / count - mean * mean) / area;
}

}  // namespace

double roughness(const Mesh& mesh) {
  const Faces faces = faces_of(mesh);
  std::vector<double> at_points(mesh.positions.size());
  parallel_for(
      at_points.size(),
      [&](std::size_t p) {
        const auto ring = faces.of_points.at(static_cast<std::uint32_t>(p));
        if (ring.empty()) return;
        at_points[p] = std::max(roughness_of(faces, ring),
                                roughness_of(faces, one_ring_more(mesh, faces, ring)));
      },
      256);
  return parallel_reduce(
      mesh.triangles.size(), 0.0,
      [&](std::size_t t) {
        const Triangle& corners = mesh.triangles[t];
        return faces.areas[t] *
               (at_points[corners[0]] + at_points[corners[1]] + at_points[corners[2]]) / 3;
      },
      [](double a, double b) { return a + b; });
}

double roughness_increase(double before, double after) {
  constexpr double kOffset = 120;
  if (before == after) return 0;
  if (!(before > 0)) return std::numeric_limits<double>::infinity();
  return std::log((after - before) / before + kOffset) - std::log(kOffset);
}

}  // namespace triglyph
