#include "engine/scheme/local_cost.h"

#include <array>
#include <vector>

namespace triglyph {
namespace {

// Of a move within the surface that counts towards the Hausdorff cost. It changes nothing by
// itself, but bends the faces that a unit shares with what other units move: if it were free, the
// distance between the whole surfaces would come out greater.
constexpr double kSlideShare = 0.1;

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
  const Halfedges& halfedges = surface.halfedges;
  const Halfedge first = halfedges.outgoing(point);
  if (first == kNoHalfedge) return;
  Halfedge spoke = first;
  do {
    if (!halfedges.is_boundary(spoke)) visit(halfedges.face(spoke));
    spoke = halfedges.turned(spoke);
  } while (spoke != first);
}

// The corners of a face from a given point on.
Corners starting_at(const Corners& corners, std::size_t first) {
  return {corners[first], corners[(first + 1) % 3], corners[(first + 2) % 3]};
}

Vec3 area_vector(const Corners& corners) {
  return area_normal(corners[0], corners[1], corners[2]) * 0.5;
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
      for (const Move& move : moves) {
        farthest = std::max(farthest, (move.to - surface_.mesh.positions[move.point]).norm());
      }
      return static_cast<float>((1 - kSlideShare) * surface_distance(moves) +
                                kSlideShare * farthest);
    case CostFunction::Normal:
      return static_cast<float>(normal_change(moves));
  }
  return kInfeasible;
}

// A moved point, the midpoints of its edges and the centroids of its faces: from the surface as it
// was, and the same places as they were from these faces as they are now. What slides within its
// surface is nearly free.
double LocalCost::surface_distance(std::span<const Move> moves) const {
  double farthest = 0;
  std::vector<Corners> before, after;  // faces about a point, from that on
  const auto weigh = [&](const Vec3& old_place, const Vec3& new_place) {
    const double reach = (new_place - old_place).norm();
    if (reach <= farthest) return;
    double back = reach;
    for (const Corners& face : after) {
      const Vec3 closest = closest_on_triangle(old_place, face[0], face[1], face[2]);
      back = std::min(back, (closest - old_place).norm());
    }
    const double there = std::min(reach, index_->closest(new_place, reach).distance);
    farthest = std::max({farthest, back, there});
  };
  for (const Move& move : moves) {
    before.clear();
    after.clear();
    visit_faces(surface_, move.point, [&](std::uint32_t face) {
      const Triangle& triangle = surface_.mesh.triangles[face];
      const auto first = static_cast<std::size_t>(
          std::find(triangle.begin(), triangle.end(), move.point) - triangle.begin());
      before.push_back(starting_at(corners_of(surface_.mesh, face), first % 3));
      after.push_back(starting_at(moved_corners(surface_.mesh, face, moves), first % 3));
    });
    weigh(surface_.mesh.positions[move.point], move.to);
    for (std::size_t i = 0; i < before.size(); ++i) {
      const Corners& old_face = before[i];
      const Corners& new_face = after[i];
      weigh((old_face[0] + old_face[1]) * 0.5, (new_face[0] + new_face[1]) * 0.5);
      weigh((old_face[0] + old_face[1] + old_face[2]) / 3.0,
            (new_face[0] + new_face[1] + new_face[2]) / 3.0);
    }
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
