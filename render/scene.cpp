#include "render/scene.h"

#include <cmath>

#include "engine/base/parallel.h"
#include "engine/mesh/point_faces.h"

namespace triglyph {
namespace {

// Returns the normals of the faces, with lengths of twice their areas.
std::vector<Vec3> area_normals(const Mesh& mesh) {
  std::vector<Vec3> normals(mesh.triangles.size());
  parallel_for(
      normals.size(),
      [&](std::size_t t) { normals[t] = area_normal(mesh.positions, mesh.triangles[t]); }, kBlock);
  return normals;
}

Vec3 unit(const Vec3& v) {
  const double length = v.norm();
  return length > 0 ? v / length : Vec3(0, 0, 0);
}

}  // namespace

Scene::Scene(const Mesh& seen, bool is_flat)
    : mesh(seen), normals(is_flat ? flat_normals(seen) : smooth_normals(seen)) {}

std::vector<Vec3> flat_normals(const Mesh& mesh) {
  std::vector<Vec3> normals = area_normals(mesh);
  for (Vec3& normal : normals) normal = unit(normal);
  return normals;
}

std::vector<Vec3> smooth_normals(const Mesh& mesh) {
  const std::vector<Vec3> of_faces = area_normals(mesh);
  const PointFaces faces = point_faces(mesh);
  const double least_cosine = std::cos(kCreaseDegrees * M_PI / 180);
  std::vector<Vec3> normals(3 * mesh.triangles.size());
  parallel_for(
      mesh.triangles.size(),
      [&](std::size_t t) {
        const Vec3 own = unit(of_faces[t]);
        for (std::size_t c = 0; c < 3; ++c) {
          const std::uint32_t point = mesh.triangles[t][c];
          Vec3 sum(0, 0, 0);
          for (const std::uint32_t face : faces.at(point)) {
            const Vec3& other = of_faces[face];
            if (dot(own, other) >= least_cosine * other.norm()) sum += other;
          }
          normals[3 * t + c] = unit(sum);
        }
      },
      1024);
  return normals;
}

}  // namespace triglyph
