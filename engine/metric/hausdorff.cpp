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
#include "engine/metric/nearby_triangles.h"

namespace triglyph {
namespace {

// A point of one surface and a distance to the other that is known not to be exceeded.
struct Sample {
  Vec3 point;
  double reach;
};

constexpr std::size_t kSamplesPerRound = 4096;

// The farthest of the samples from the surface. Those with the greatest reach go first; a sample
// whose reach is within the farthest yet cannot change the answer, so the order does not matter to
// it.
double farthest_sample(std::vector<Sample> samples, const SpatialIndex& surface) {
  const auto greater = [](const Sample& a, const Sample& b) { return a.reach > b.reach; };
  double farthest = 0;
  std::vector<double> distances(kSamplesPerRound);
  while (!samples.empty()) {
    const std::size_t count = std::min(kSamplesPerRound, samples.size());
    std::nth_element(samples.begin(), samples.begin() + static_cast<std::ptrdiff_t>(count - 1),
                     samples.end(), greater);
    parallel_for(
        count,
        [&](std::size_t i) {
          const double distance = surface.closest(samples[i].point, samples[i].reach).distance;
          distances[i] = std::min(distance, samples[i].reach);
        },
        64);
    farthest = std::max(farthest,
                        *std::max_element(distances.begin(),
                                          distances.begin() + static_cast<std::ptrdiff_t>(count)));
    samples.erase(samples.begin(), samples.begin() + static_cast<std::ptrdiff_t>(count));
    std::erase_if(samples, [&](const Sample& sample) { return sample.reach <= farthest; });
  }
  return farthest;
}

// Samples of the given triangles: each point once, and the midpoints of the edges and the centroid
// of every triangle. make(blend) makes a sample of a function that blends positions.
template <typename Make>
std::vector<Sample> take_samples(std::span<const Triangle> triangles, const Make& make) {
  std::vector<std::uint32_t> points;
  points.reserve(3 * triangles.size());
  for (const Triangle& triangle : triangles) {
    points.insert(points.end(), triangle.begin(), triangle.end());
  }
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());

  using Positions = std::span<const Vec3>;
  std::vector<Sample> samples;
  samples.reserve(points.size() + 4 * triangles.size());
  for (const std::uint32_t point : points) {
    samples.push_back(make([&](Positions at) { return at[point]; }));
  }
  for (const Triangle& t : triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      samples.push_back(make([&](Positions at) { return (at[t[i]] + at[t[(i + 1) % 3]]) / 2; }));
    }
    samples.push_back(make([&](Positions at) { return (at[t[0]] + at[t[1]] + at[t[2]]) / 3; }));
  }
  return samples;
}

// Each sample is at most its own displacement from the other surface.
std::vector<Sample> samples_of_move(std::span<const Triangle> moved, std::span<const Vec3> here,
                                    std::span<const Vec3> there) {
  std::vector<Sample> samples = take_samples(moved, [&](const auto& blend) {
    const Vec3 point = blend(here);
    return Sample{point, (point - blend(there)).norm()};
  });
  std::erase_if(samples, [](const Sample& sample) { return sample.reach == 0; });
  return samples;
}

std::vector<Sample> samples_of(const Mesh& mesh) {
  return take_samples(mesh.triangles, [&](const auto& blend) {
    return Sample{blend(mesh.positions), std::numeric_limits<double>::infinity()};
  });
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
  const std::vector<Triangle> nearby = nearby_triangles(triangles, moved, before, after);
  HausdorffDistance distance;
  const auto one_way = [&](std::span<const Vec3> here, std::span<const Vec3> there) {
    return farthest_sample(samples_of_move(moved, here, there), SpatialIndex(there, nearby));
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
    return farthest_sample(samples_of(from), SpatialIndex(to.positions, to.triangles));
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
