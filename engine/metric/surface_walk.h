// Walks over the edges of a surface within a ball, for measures of local shape.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/parallel.h"
#include "engine/mesh/edge_graph.h"
#include "engine/mesh/mesh.h"

namespace triglyph {

// Returns the share, 0 to 1, of the segment from `from` to `from + along` that lies within `radius`
// of `centre`. Precondition: `from` lies within it.
[[nodiscard]] inline double share_within(const Vec3& centre, double radius, const Vec3& from,
                                         const Vec3& along) {
  const Vec3 arm = from - centre;
  const double a = along.sqrnorm();
  const double half_b = dot(along, arm);
  const double c = arm.sqrnorm() - radius * radius;
  const double root = std::sqrt(std::max(0.0, half_b * half_b - a * c));
  const double share = a > 0 ? (root - half_b) / a : 1;
  return std::min(1.0, std::max(0.0, share));
}

// Keeps its memory between walks, so that one object serves many points.
class SurfaceWalk {
 public:
  // Both must outlive the walk.
  SurfaceWalk(std::span<const Vec3> positions, const EdgeGraph& graph)
      : positions_(positions), graph_(graph), states_(positions.size(), 0) {}

  // Walks over the part of the surface that lies within `radius` (model units) of the start and is
  // connected to it there. Calls visit(from, spoke, share, is_new) once for every edge with an end
  // in that part, where `share` is the share of the edge within the radius, and `is_new` tells that
  // the edge is the first to reach its other end (with share 1). The order is fixed. O(edges
  // visited).
  template <typename Visit>
  void visit(std::uint32_t start, double radius, const Visit& visit) {
    round_ += 2;
    const Vec3& centre = positions_[start];
    states_[start] = round_;
    queue_.assign(1, start);
    for (std::size_t next = 0; next < queue_.size(); ++next) {
      const std::uint32_t from = queue_[next];
      states_[from] = round_ + 1;
      for (const EdgeGraph::Spoke& spoke : graph_.around(from)) {
        if (states_[spoke.to] == round_ + 1) continue;  // visited from the other end
        const Vec3 along = positions_[spoke.to] - positions_[from];
        const double share = share_within(centre, radius, positions_[from], along);
        const bool is_new = share >= 1 && states_[spoke.to] != round_;
        if (is_new) {
          states_[spoke.to] = round_;
          queue_.push_back(spoke.to);
        }
        visit(from, spoke, share, is_new);
      }
    }
  }

 private:
  std::span<const Vec3> positions_;
  const EdgeGraph& graph_;
  std::vector<std::uint64_t> states_;  // round_: queued; round_ + 1: its edges are visited
  std::uint64_t round_ = 0;
  std::vector<std::uint32_t> queue_;
};

// Calls body(walk, point) for every point, in parallel.
template <typename Body>
void parallel_walks(std::span<const Vec3> positions, const EdgeGraph& graph, const Body& body) {
  // few enough walks that their memory is negligible
  const std::size_t block = std::max<std::size_t>(512, positions.size() / 64);
  parallel_blocks(
      positions.size(),
      [&](std::size_t begin, std::size_t end) {
        SurfaceWalk walk(positions, graph);
        for (std::size_t p = begin; p < end; ++p) body(walk, static_cast<std::uint32_t>(p));
      },
      block);
}

}  // namespace triglyph
