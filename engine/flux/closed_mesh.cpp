#include "engine/flux/closed_mesh.h"

#include <algorithm>
#include <numeric>

namespace triglyph {
namespace {

// The area of the fans, in terms of the mesh's own, from which on they and not the mesh enclose the
// solid. Of the meshes of two collections that could be marked it was 1.5 at most, of loose
// triangles that hang together by their corners 16 and 39; these fans would also take minutes.
constexpr double kMostFans = 4;

// Sets of points that are joined one pair at a time; the least point stands for its set.
class Components {
 public:
  explicit Components(std::size_t points) : parent_(points) {
    std::iota(parent_.begin(), parent_.end(), 0U);
  }
  [[nodiscard]] std::uint32_t of(std::uint32_t point) {
    while (parent_[point] != point) {
      parent_[point] = parent_[parent_[point]];
      point = parent_[point];
    }
    return point;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = of(a);
    b = of(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace

ClosedMesh::ClosedMesh(const Surface& surface, EdgeWeight weight)
    : weight_(weight),
      points_(surface.mesh.positions.size()),
      own_triangles_(surface.mesh.triangles.size()),
      triangles_(surface.mesh.triangles) {
  const Halfedges& halfedges = surface.halfedges;
  std::vector<Halfedge> boundary;  // on the side of the hole
  for (std::uint32_t edge = 0; edge < halfedges.edge_count(); ++edge) {
    const Halfedge side = halfedges.of_edge(edge, 1);
    if (halfedges.is_boundary(side)) boundary.push_back(side);
  }
  if (boundary.empty()) return;
  Components components(points_);
  for (const Halfedge side : boundary) components.join(halfedges.from(side), halfedges.to(side));
  std::vector<std::uint32_t> roots;
  roots.reserve(boundary.size());
  for (const Halfedge side : boundary) roots.push_back(components.of(halfedges.from(side)));
  std::vector<std::uint32_t> holes = roots;
  std::sort(holes.begin(), holes.end());
  holes.erase(std::unique(holes.begin(), holes.end()), holes.end());
  holes_ = holes.size();
  for (std::size_t i = 0; i < boundary.size(); ++i) {
    const auto hole = std::lower_bound(holes.begin(), holes.end(), roots[i]) - holes.begin();
    triangles_.push_back({halfedges.from(boundary[i]), halfedges.to(boundary[i]),
                          static_cast<std::uint32_t>(points_ + static_cast<std::size_t>(hole))});
  }
}

std::vector<Vec3> ClosedMesh::with_centres(std::span<const Vec3> positions) const {
  std::vector<Vec3> all(positions.begin(), positions.end());
  all.resize(points_ + holes_);
  std::vector<double> totals(holes_, 0);
  // The fans follow the mesh's own triangles; their last corner is the centre.
  for (auto fan = triangles_.rbegin(); fan != triangles_.rend() && (*fan)[2] >= points_; ++fan) {
    const Triangle& corners = *fan;
    const Vec3 &a = positions[corners[0]], &b = positions[corners[1]];
    const double weight = weight_ == EdgeWeight::Length ? (a - b).norm() : 1;
    all[corners[2]] += weight * (a + b);
    totals[corners[2] - points_] += 2 * weight;
  }
  for (std::size_t hole = 0; hole < holes_; ++hole) {
    if (totals[hole] > 0) all[points_ + hole] /= totals[hole];
  }
  return all;
}

std::optional<SolidFrame> ClosedMesh::frame(std::span<const Vec3> positions) const {
  if (holes_ > 0) {
    const auto area = [&](std::size_t begin, std::size_t end) {
      double sum = 0;
      for (std::size_t t = begin; t < end; ++t) sum += area_normal(positions, triangles_[t]).norm();
      return sum;
    };
    const double own = area(0, own_triangles_);
    if (area(own_triangles_, triangles_.size()) > kMostFans * own) return std::nullopt;
  }
  return solid_frame(positions, triangles_);
}

}  // namespace triglyph
