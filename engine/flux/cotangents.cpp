#include "engine/flux/cotangents.h"

#include <algorithm>

namespace triglyph {
namespace {

constexpr double kLeastCotangent = 0.02;
constexpr double kMostCotangent = 20;

// Of a point, in relation to the mean.
constexpr double kLeastArea = 1e-3;

}  // namespace

std::vector<double> point_areas(const Mesh& mesh) {
  std::vector<double> areas(mesh.positions.size(), 0);
  double total = 0;
  for (const Triangle& t : mesh.triangles) {
    const double area = triangle_area(mesh.positions, t);
    total += area;
    for (const std::uint32_t point : t) areas[point] += area / 3;
  }
  const double least = kLeastArea * total / static_cast<double>(areas.size());
  for (double& area : areas) area = std::max(area, least);
  return areas;
}

double cotangent_weight(const Vec3& apex, const Vec3& a, const Vec3& b) {
  const Vec3 u = a - apex;
  const Vec3 v = b - apex;
  const double sine = std::max(cross(u, v).norm(), 1e-12 * u.norm() * v.norm());
  const double cotangent = sine > 0 ? dot(u, v) / sine : kLeastCotangent;
  return std::clamp(cotangent, kLeastCotangent, kMostCotangent) / 2;
}

}  // namespace triglyph
