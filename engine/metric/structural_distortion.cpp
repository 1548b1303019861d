#include "engine/metric/structural_distortion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "engine/base/error.h"
#include "engine/base/parallel.h"
#include "engine/geometry/box.h"
#include "engine/geometry/spatial_index.h"
#include "engine/metric/curvature.h"
#include "engine/metric/surface_walk.h"

namespace triglyph {
namespace {

// The points of a surface with their curvatures, and for each point its place on the other surface
// with the curvature there. Curvatures are multiplied by the size of the mesh, so they are
// dimensionless.
struct Matched {
  std::span<const Vec3> positions;
  const EdgeGraph& graph;
  std::span<const double> curvatures;
  std::span<const Vec3> places;
  std::span<const double> curvatures_there;
};

struct Window {
  double radius = 0;
  double deviation = 0;  // standard deviation of its Gaussian weights
};

// One place in a window, on both surfaces.
struct Sample {
  double here, there;                // curvatures
  double weight_here, weight_there;  // from the distance to the window's centre
};

// Weighted moments of the two curvatures in a window.
struct Moments {
  double mean_here = 0, mean_there = 0;
  double deviation_here = 0, deviation_there = 0;
  double covariance = 0;
};

Moments moments_of(std::span<const Sample> samples) {
  double weight_here = 0, weight_there = 0;
  Moments m;
  for (const Sample& s : samples) {
    weight_here += s.weight_here;
    weight_there += s.weight_there;
    m.mean_here += s.weight_here * s.here;
    m.mean_there += s.weight_there * s.there;
  }
  m.mean_here /= weight_here;
  m.mean_there /= weight_there;
  for (const Sample& s : samples) {
    const double here = s.here - m.mean_here;
    const double there = s.there - m.mean_there;
    m.deviation_here += s.weight_here * here * here;
    m.deviation_there += s.weight_there * there * there;
    m.covariance += s.weight_there * here * there;
  }
  m.deviation_here = std::sqrt(m.deviation_here / weight_here);
  m.deviation_there = std::sqrt(m.deviation_there / weight_there);
  m.covariance /= weight_here;
  return m;
}

// Returns the three terms, whose weights in the mean below are 1, 1 and 1/2.
std::array<double, 3> terms_of(const Moments& m) {
  const double product = m.deviation_here * m.deviation_there;
  return {std::abs(m.mean_here - m.mean_there) / (std::max(m.mean_here, m.mean_there) + 1),
          std::abs(m.deviation_here - m.deviation_there) /
              (std::max(m.deviation_here, m.deviation_there) + 1),
          std::abs(product - m.covariance) / (product + 1)};
}

double weighted_mean(const std::array<double, 3>& terms, double exponent) {
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    sum += (i < 2 ? 1 : 0.5) * std::pow(terms[i], exponent);
  }
  return std::pow(sum / 2.5, 1 / exponent);
}

double gaussian(const Vec3& a, const Vec3& b, double deviation) {
  return std::exp(-(a - b).sqrnorm() / (2 * deviation * deviation));
}

// Returns the distortion at every point, or 0 at all but one in so many.
std::vector<double> local_distortion(const Matched& m, const Window& window, double exponent,
                                     std::size_t one_in = 1) {
  std::vector<double> distortion(m.positions.size(), 0);
  parallel_walks(m.positions, m.graph, [&](SurfaceWalk& walk, std::uint32_t centre) {
    if (centre % one_in != 0 || m.graph.around(centre).empty()) return;
    std::vector<Sample> samples{{m.curvatures[centre], m.curvatures_there[centre], 1, 1}};
    walk.visit(
        centre, window.radius,
        [&](std::uint32_t from, const EdgeGraph::Spoke& spoke, double share, bool is_new) {
          if (share >= 1 && !is_new) return;
          const auto at = [&](const auto& values) {
            return values[from] + (values[spoke.to] - values[from]) * share;
          };
          samples.push_back({at(m.curvatures), at(m.curvatures_there),
                             gaussian(at(m.positions), m.positions[centre], window.deviation),
                             gaussian(at(m.places), m.places[centre], window.deviation)});
        });
    distortion[centre] = weighted_mean(terms_of(moments_of(samples)), exponent);
  });
  return distortion;
}

// Returns the power mean, with exponent 3, over one in so many of the points that have edges.
double pooled(std::span<const double> distortion, const EdgeGraph& graph, std::size_t one_in = 1) {
  double sum = 0;
  double count = 0;
  for (std::uint32_t p = 0; p < distortion.size(); ++p) {
    if (p % one_in != 0 || graph.around(p).empty()) continue;
    sum += distortion[p] * distortion[p] * distortion[p];
    count += 1;
  }
  return count > 0 ? std::cbrt(sum / count) : 0;
}

double longest_side(std::span<const Vec3> points) {
  return bounding_box(points).size().max();
}

std::vector<double> relative_curvatures(const Mesh& mesh, const EdgeGraph& graph, double radius,
                                        double size) {
  std::vector<double> curvatures = mean_curvatures(mesh, graph, radius);
  for (double& curvature : curvatures) curvature *= size;
  return curvatures;
}

// Returns the value at a place on a triangle, interpolated linearly between its corners.
double interpolated(const Mesh& mesh, std::span<const double> values, const ClosestPoint& place) {
  const Triangle& t = mesh.triangles[place.triangle];
  double total = 0, sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 a = mesh.positions[t[(i + 1) % 3]] - place.point;
    const Vec3 b = mesh.positions[t[(i + 2) % 3]] - place.point;
    const double share = cross(a, b).norm();
    total += share;
    sum += share * values[t[i]];
  }
  if (total > 0) return sum / total;
  return (values[t[0]] + values[t[1]] + values[t[2]]) / 3;
}

constexpr std::array<double, 3> kScales = {0.002, 0.003, 0.004};

double msdm2_one_way(const Mesh& here, const Mesh& there, std::size_t at_most) {
  const std::size_t one_in = std::max<std::size_t>(1, (here.positions.size() - 1) / at_most + 1);
  const EdgeGraph graph = edge_graph(here);
  const EdgeGraph graph_there = edge_graph(there);
  const double size = longest_side(here.positions);
  const SpatialIndex surface(there.positions, there.triangles);
  std::vector<ClosestPoint> nearest(here.positions.size());
  parallel_for(
      nearest.size(),
      [&](std::size_t p) {
        nearest[p] = surface.closest(here.positions[p], std::numeric_limits<double>::infinity());
      },
      256);
  std::vector<Vec3> places;
  places.reserve(nearest.size());
  for (const ClosestPoint& place : nearest) places.push_back(place.point);

  std::vector<double> sum(here.positions.size(), 0);
  for (const double scale : kScales) {
    const double radius = scale * size;
    const auto curvatures = relative_curvatures(here, graph, radius, size);
    const auto of_other = relative_curvatures(there, graph_there, radius, size);
    std::vector<double> matched(nearest.size());
    for (std::size_t p = 0; p < matched.size(); ++p) {
      matched[p] = interpolated(there, of_other, nearest[p]);
    }
    const auto distortion = local_distortion({here.positions, graph, curvatures, places, matched},
                                             {5 * radius, 2.5 * radius}, 1, one_in);
    for (std::size_t p = 0; p < sum.size(); ++p) sum[p] += distortion[p] / kScales.size();
  }
  return pooled(sum, graph, one_in);
}

}  // namespace

double msdm(const Mesh& first, const Mesh& second) {
  check(first.positions.size() == second.positions.size(), "msdm needs the same points");
  if (first.triangles.empty()) return 0;
  const EdgeGraph graph = edge_graph(first);
  const double size = longest_side(first.positions);
  const auto before = relative_curvatures(first, graph, 0.005 * size, size);
  const auto after = relative_curvatures(second, graph, 0.005 * size, size);
  const Window window{0.015 * size, 0.008 * size};
  const Matched forth{first.positions, graph, before, second.positions, after};
  const Matched back{second.positions, graph, after, first.positions, before};
  return (pooled(local_distortion(forth, window, 3), graph) +
          pooled(local_distortion(back, window, 3), graph)) /
         2;
}

double msdm2(const Mesh& first, const Mesh& second, std::size_t at_most) {
  if (first.triangles.empty() || second.triangles.empty()) {
    throw Error(ErrorCode::Usage, {}, "", "a mesh without faces has no structure to compare");
  }
  return (msdm2_one_way(first, second, at_most) + msdm2_one_way(second, first, at_most)) / 2;
}

}  // namespace triglyph
