#include "engine/scheme/local_cost.h"

#include <array>

namespace triglyph {
namespace {

using Corners = std::array<Vec3, 3>;

Corners corners_of(const Mesh& mesh, std::uint32_t face) {
  const Triangle& triangle = mesh.triangles[face];
  return {mesh.positions[triangle[0]], mesh.positions[triangle[1]], mesh.positions[triangle[2]]};
}

Corners moved_corners(const Mesh& mesh, std::uint32_t face, std::span<const Move> moves) {
  Corners corners = corners_of(mesh, face);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::uint32_t point = mesh.triangles[face][i];
    for (const Move& move : moves) {
      if (move.point == point) corners[i] = move.to;
    }
  }
  return corners;
}

// Calls visit(face) for the faces of a point's first fan.
template <typename Visit>
void visit_faces(const Surface& surface, std::uint32_t point, const Visit& visit) {
  const OpenMesh::VertexHandle vertex(static_cast<int>(point));
  for (const auto face : surface.halfedges.kernel.vf_range(vertex)) {
    visit(static_cast<std::uint32_t>(face.idx()));
  }
}

Vec3 area_vector(const Corners& corners) {
  return cross(corners[1] - corners[0], corners[2] - corners[0]) * 0.5;
}

}  // namespace

LocalCost::LocalCost(const Surface& surface, CostFunction function)
    : surface_(surface), function_(function) {
  if (function == CostFunction::Hausdorff) {
    index_.emplace(surface.mesh.positions, surface.mesh.triangles);
  }
}

float LocalCost::of_part(std::span<const Move> moves) const {
  double farthest = 0;
  double sum_of_squares = 0;
  switch (function_) {
    case CostFunction::Displacement:
    case CostFunction::Rms:
      for (const Move& move : moves) {
        const double squared = (move.to - surface_.mesh.positions[move.point]).sqrnorm();
        farthest = std::max(farthest, squared);
        sum_of_squares += squared;
      }
      return static_cast<float>(function_ == CostFunction::Rms ? sum_of_squares
                                                               : std::sqrt(farthest));
    case CostFunction::Hausdorff:
      return static_cast<float>(surface_distance(moves));
    case CostFunction::Normal:
      return static_cast<float>(normal_change(moves));
  }
  return kInfeasible;
}

// The moved points from the surface as it was, and their old places from the faces around them as
// they are now. A point that slides within its surface is nearly free.
double LocalCost::surface_distance(std::span<const Move> moves) const {
  double farthest = 0;
  for (const Move& move : moves) {
    const Vec3& from = surface_.mesh.positions[move.point];
    const double reach = (move.to - from).norm();
    if (reach <= farthest) continue;
    farthest = std::max(farthest, std::min(reach, index_->closest(move.to, reach).distance));
    double back = reach;
    visit_faces(surface_, move.point, [&](std::uint32_t face) {
      const Corners now = moved_corners(surface_.mesh, face, moves);
      back = std::min(back, (closest_on_triangle(from, now[0], now[1], now[2]) - from).norm());
    });
    farthest = std::max(farthest, back);
  }
  return farthest;
}

// The greatest change of a unit normal, times the root of the face's area: how much shading changes
// over how wide a stretch. Faces that have no normal are left alone; none may lose its own.
double LocalCost::normal_change(std::span<const Move> moves) const {
  double greatest = 0;
  for (const Move& move : moves) {
    visit_faces(surface_, move.point, [&](std::uint32_t face) {
      const Vec3 before = area_vector(corners_of(surface_.mesh, face));
      const Vec3 after = area_vector(moved_corners(surface_.mesh, face, moves));
      const double area = before.norm();
      const double new_area = after.norm();
      if (!(area > 0)) return;
      const double change = new_area > 0 ? (after / new_area - before / area).norm() : 2;
      greatest = std::max(greatest, change * std::sqrt(area));
    });
  }
  return greatest;
}

}  // namespace triglyph
