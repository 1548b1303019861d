// This work is based on:
// Cignoni, Rocchini, Scopigno. Metro: measuring error on simplified surfaces. CGF 17(2) (1998).
#include "engine/metric/hausdorff.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "engine/base/error.h"
#include "engine/base/parallel.h"
#include "engine/geometry/spatial_index.h"
#include "engine/metric/nearby_triangles.h"

namespace triglyph {
namespace {

// Returns an upper bound of the distance for every triangle: no point of it moves farther than the
// corners do.
std::vector<double> reach_of_moves(std::span<const Triangle> moved, std::span<const Vec3> before,
                                   std::span<const Vec3> after) {
  std::vector<double> reach(moved.size());
  parallel_for(
      moved.size(),
      [&](std::size_t t) {
        for (const std::uint32_t point : moved[t]) {
          reach[t] = std::max(reach[t], (after[point] - before[point]).norm());
        }
      },
      kBlock);
  return reach;
}

}  // namespace

double HausdorffDistance::error() const {
  return std::max(forward.distance + forward.error, backward.distance + backward.error) -
         symmetric();
}

HausdorffDistance hausdorff_of_move(std::span<const Triangle> triangles,
                                    std::span<const Vec3> before, std::span<const Vec3> after,
                                    double tolerance) {
  const auto moved =
      parallel_collect<Triangle>(triangles.size(), [&](std::size_t t, std::vector<Triangle>& out) {
        const bool stays =
            std::all_of(triangles[t].begin(), triangles[t].end(),
                        [&](std::uint32_t point) { return before[point] == after[point]; });
        if (!stays) out.push_back(triangles[t]);
      });
  if (moved.empty()) return {};
  const std::vector<Triangle> nearby = nearby_triangles(triangles, moved, before, after);
  const std::vector<double> reach = reach_of_moves(moved, before, after);
  const auto one_way = [&](std::span<const Vec3> here, std::span<const Vec3> there) {
    return farthest_point(here, moved, reach, SpatialIndex(there, nearby), {tolerance});
  };
  HausdorffDistance distance;
  parallel_pair([&] { distance.forward = one_way(before, after); },
                [&] { distance.backward = one_way(after, before); });
  return distance;
}

HausdorffDistance hausdorff(const Mesh& first, const Mesh& second, double tolerance) {
  if (first.triangles.empty() || second.triangles.empty()) {
    throw Error(ErrorCode::Usage, {}, "", "a mesh without faces has no distance to another");
  }
  const auto one_way = [&](const Mesh& from, const Mesh& to) {
    const std::vector<double> reach(from.triangles.size(), std::numeric_limits<double>::infinity());
    return farthest_point(from.positions, from.triangles, reach,
                          SpatialIndex(to.positions, to.triangles), {tolerance});
  };
  HausdorffDistance distance;
  parallel_pair([&] { distance.forward = one_way(first, second); },
                [&] { distance.backward = one_way(second, first); });
  return distance;
}

}  // namespace triglyph
