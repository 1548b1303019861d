// This work is based on:
// Cignoni, Rocchini, Scopigno. Metro: measuring error on simplified surfaces. CGF 17(2) (1998).
#include "engine/metric/hausdorff.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "engine/base/error.h"
#include "engine/base/parallel.h"
#include "engine/mesh/spatial_index.h"

namespace triglyph {
namespace {

// A point of one surface and a distance to the other that is known not to be exceeded.
struct Sample {
  Vec3 point;
  double reach;
};

constexpr std::size_t kSamplesPerRound = 8192;

// The farthest of the samples from the surface. Samples with the greatest reach go first; a round
// whose reaches are all within the farthest yet cannot change the answer, and the rounds are fixed,
// so neither can the threads.
double farthest_sample(std::vector<Sample>& samples, const SpatialIndex& surface) {
  std::stable_sort(samples.begin(), samples.end(),
                   [](const Sample& a, const Sample& b) { return a.reach > b.reach; });
  double farthest = 0;
  std::vector<double> distances(kSamplesPerRound);
  for (std::size_t begin = 0; begin < samples.size(); begin += kSamplesPerRound) {
    if (samples[begin].reach <= farthest) break;
    const std::size_t count = std::min(kSamplesPerRound, samples.size() - begin);
    parallel_for(
        count,
        [&](std::size_t i) {
          const Sample& sample = samples[begin + i];
          distances[i] =
              sample.reach <= farthest ? 0 : surface.closest(sample.point, sample.reach).distance;
        },
        64);
    for (std::size_t i = 0; i < count; ++i) {
      const double reach = samples[begin + i].reach;
      farthest = std::max(farthest, std::min(distances[i], reach));
    }
  }
  return farthest;
}

// Corners, edge midpoints and centroid as weights of the triangle's corners; points and edges are
// shared by triangles and come once for each, which costs time but changes nothing.
constexpr double kThird = 1.0 / 3;
constexpr std::array<std::array<double, 3>, 7> kWeights{{{1, 0, 0},
                                                         {0, 1, 0},
                                                         {0, 0, 1},
                                                         {0.5, 0.5, 0},
                                                         {0, 0.5, 0.5},
                                                         {0.5, 0, 0.5},
                                                         {kThird, kThird, kThird}}};

Vec3 blend(const Triangle& triangle, std::span<const Vec3> positions,
           const std::array<double, 3>& weights) {
  return positions[triangle[0]] * weights[0] + positions[triangle[1]] * weights[1] +
         positions[triangle[2]] * weights[2];
}

// Samples of the moved triangles at `here`, each at most its own displacement from `there`.
std::vector<Sample> samples_of_move(std::span<const Triangle> moved, std::span<const Vec3> here,
                                    std::span<const Vec3> there) {
  std::vector<Sample> samples;
  samples.reserve(kWeights.size() * moved.size());
  for (const Triangle& triangle : moved) {
    for (const auto& weights : kWeights) {
      const Vec3 point = blend(triangle, here, weights);
      const double reach = (point - blend(triangle, there, weights)).norm();
      if (reach > 0) samples.push_back({point, reach});
    }
  }
  return samples;
}

std::vector<Sample> samples_of(const Mesh& mesh) {
  std::vector<Sample> samples;
  samples.reserve(kWeights.size() * mesh.triangles.size());
  for (const Triangle& triangle : mesh.triangles) {
    for (const auto& weights : kWeights) {
      samples.push_back(
          {blend(triangle, mesh.positions, weights), std::numeric_limits<double>::infinity()});
    }
  }
  return samples;
}

}  // namespace

HausdorffDistance hausdorff_of_move(std::span<const Triangle> triangles,
                                    std::span<const Vec3> before, std::span<const Vec3> after) {
  std::vector<Triangle> moved;
  for (const Triangle& triangle : triangles) {
    const bool stays = std::all_of(triangle.begin(), triangle.end(), [&](std::uint32_t point) {
      return before[point] == after[point];
    });
    if (!stays) moved.push_back(triangle);
  }
  if (moved.empty()) return {};
  HausdorffDistance distance;
  const auto one_way = [&](std::span<const Vec3> here, std::span<const Vec3> there) {
    std::vector<Sample> samples = samples_of_move(moved, here, there);
    return farthest_sample(samples, SpatialIndex(there, triangles));
  };
  distance.forward = one_way(before, after);
  distance.backward = one_way(after, before);
  return distance;
}

HausdorffDistance hausdorff(const Mesh& first, const Mesh& second) {
  if (first.triangles.empty() || second.triangles.empty()) {
    throw Error(ErrorCode::Usage, {}, "", "a mesh without faces has no distance to another");
  }
  const auto one_way = [](const Mesh& from, const Mesh& to) {
    std::vector<Sample> samples = samples_of(from);
    return farthest_sample(samples, SpatialIndex(to.positions, to.triangles));
  };
  return {one_way(first, second), one_way(second, first)};
}

Displacement displacement(std::span<const Vec3> before, std::span<const Vec3> after) {
  check(before.size() == after.size(), "displacements need the same points");
  if (before.empty()) return {};
  const auto squared = [&](std::size_t i) { return (after[i] - before[i]).sqrnorm(); };
  const double largest = parallel_reduce(before.size(), 0.0, squared,
                                         [](double a, double b) { return std::max(a, b); });
  const double sum =
      parallel_reduce(before.size(), 0.0, squared, [](double a, double b) { return a + b; });
  return {std::sqrt(largest), std::sqrt(sum / static_cast<double>(before.size()))};
}

double box_diagonal(std::span<const Vec3> points) {
  if (points.empty()) return 0;
  Vec3 low = points[0];
  Vec3 high = points[0];
  for (const Vec3& point : points) {
    low.minimize(point);
    high.maximize(point);
  }
  return (high - low).norm();
}

}  // namespace triglyph
