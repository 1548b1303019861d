#include "engine/metric/sampled_distance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "engine/base/error.h"
#include "engine/base/parallel.h"
#include "engine/geometry/spatial_index.h"
#include "engine/mesh/edge_graph.h"
#include "engine/mesh/surface_points.h"

namespace triglyph {
namespace {

constexpr double kRounding = 1e-15;

// Computes the distances of points close to each other: the triangle nearest to the last point
// bounds the reach of the next query.
class Probe {
 public:
  explicit Probe(const SpatialIndex& surface) : surface_(surface) {}

  double distance(const Vec3& point) {
    const double reach = last_ == kNoTriangle ? std::numeric_limits<double>::infinity()
                                              : surface_.distance_to(point, last_);
    // on that triangle up to rounding; saves the query where many faces coincide
    if (reach <= kRounding * point.max_abs()) return reach;
    const ClosestPoint found = surface_.closest(point, reach);
    last_ = found.triangle;
    return found.distance;
  }

 private:
  const SpatialIndex& surface_;
  std::uint32_t last_ = kNoTriangle;
};

// Weighted sums of distances. The weight of a sample is 1 in Metro, its area in MESH.
struct Sums {
  double max = 0, weight = 0, first = 0, second = 0;
  std::uint64_t samples = 0;

  void add(double distance) {
    max = std::max(max, distance);
    weight += 1;
    first += distance;
    second += distance * distance;
    ++samples;
  }
  [[nodiscard]] DistanceStatistics statistics() const {
    if (!(weight > 0)) return {};
    return {max, first / weight, std::sqrt(second / weight), samples};
  }
};

Sums join(const Sums& a, const Sums& b) {
  return {std::max(a.max, b.max), a.weight + b.weight, a.first + b.first, a.second + b.second,
          a.samples + b.samples};
}

// Returns the sum of what visit(i, probe, sums) adds for i in [0, n).
template <typename Visit>
Sums fold(std::size_t n, const SpatialIndex& surface, const Visit& visit) {
  const std::size_t blocks = (n + kBlock - 1) / kBlock;
  std::vector<Sums> partial(blocks);
  parallel_for(blocks, [&](std::size_t b) {
    Probe probe(surface);
    const std::size_t end = std::min(n, (b + 1) * kBlock);
    for (std::size_t i = b * kBlock; i < end; ++i) visit(i, probe, partial[b]);
  });
  Sums sums;
  for (const Sums& part : partial) sums = join(sums, part);
  return sums;
}

double area_of(const Mesh& mesh) {
  return parallel_reduce(
      mesh.triangles.size(), 0.0,
      [&](std::size_t t) { return triangle_area(mesh.positions, mesh.triangles[t]); },
      [](double a, double b) { return a + b; });
}

// Rounds fractional sample counts to integers, carrying each remainder to the next.
std::vector<std::uint32_t> whole_samples(std::span<const double> shares) {
  std::vector<std::uint32_t> counts(shares.size());
  double carried = 0;
  for (std::size_t i = 0; i < shares.size(); ++i) {
    carried += shares[i];
    counts[i] = static_cast<std::uint32_t>(carried);
    carried -= counts[i];
  }
  return counts;
}

class Metro {
 public:
  Metro(const Mesh& mesh, const SpatialIndex& other, double target)
      : mesh_(mesh), other_(other), target_(target), area_(area_of(mesh)) {}

  DistanceStatistics run() {
    Sums sums = vertices();
    const auto vertex_samples = static_cast<double>(sums.samples);
    const double left = target_ - vertex_samples;
    if (left > 0 && area_ > 0) {
      const Sums on_edges = edges(std::sqrt(left / area_), left);
      sums = join(sums, on_edges);
      const double for_faces = left - vertex_samples - static_cast<double>(on_edges.samples);
      if (for_faces > 0) sums = join(sums, faces(for_faces / area_));
    }
    return sums.statistics();
  }

 private:
  Sums vertices() {
    const std::vector<std::uint32_t> points = surface_points(mesh_);
    return fold(points.size(), other_, [&](std::size_t i, Probe& probe, Sums& sums) {
      sums.add(probe.distance(mesh_.positions[points[i]]));
    });
  }

  // Needles have long edges and hardly any area, which alone would ask for any number of samples.
  Sums edges(double samples_a_length, double most) {
    const std::vector<Edge> edges = edge_graph(mesh_).edges;
    std::vector<double> shares(edges.size());
    double wanted = 0;
    for (std::size_t e = 0; e < edges.size(); ++e) {
      shares[e] =
          samples_a_length * (mesh_.positions[edges[e].to] - mesh_.positions[edges[e].from]).norm();
      wanted += shares[e];
    }
    if (wanted > most) {
      for (double& share : shares) share *= most / wanted;
    }
    const std::vector<std::uint32_t> counts = whole_samples(shares);
    return fold(edges.size(), other_, [&](std::size_t e, Probe& probe, Sums& sums) {
      const Vec3& from = mesh_.positions[edges[e].from];
      const Vec3 step = (mesh_.positions[edges[e].to] - from) / (counts[e] + 1.0);
      for (std::uint32_t i = 1; i <= counts[e]; ++i) sums.add(probe.distance(from + step * i));
    });
  }

  Sums faces(double samples_an_area) {
    std::vector<double> shares(mesh_.triangles.size());
    for (std::size_t t = 0; t < shares.size(); ++t) {
      shares[t] = samples_an_area * triangle_area(mesh_.positions, mesh_.triangles[t]);
    }
    const std::vector<std::uint32_t> counts = whole_samples(shares);
    return fold(counts.size(), other_, [&](std::size_t t, Probe& probe, Sums& sums) {
      if (counts[t] > 0) similar_triangles(mesh_.triangles[t], counts[t], probe, sums);
    });
  }

  // Samples the inner points of a grid of similar triangles that has about `count` of them.
  void similar_triangles(const Triangle& t, std::uint32_t count, Probe& probe, Sums& sums) const {
    const auto rows = static_cast<int>((std::sqrt(1 + 8.0 * count) + 5) / 2);
    const Vec3& corner = mesh_.positions[t[0]];
    const Vec3 along = (mesh_.positions[t[1]] - corner) / (rows - 1);
    const Vec3 across = (mesh_.positions[t[2]] - corner) / (rows - 1);
    for (int i = 1; i <= rows - 2; ++i) {
      for (int j = 1; j <= rows - 2 - i; ++j) {
        sums.add(probe.distance(corner + along * i + across * j));
      }
    }
  }

  const Mesh& mesh_;
  const SpatialIndex& other_;
  double target_;
  double area_;
};

// Adds the integrals of the distance and of its square over a triangle, the distance being linear
// between the corners.
void integrate(const std::array<double, 3>& d, double area, Sums& sums) {
  const double sum = d[0] + d[1] + d[2];
  const double squares = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
  sums.weight += area;
  sums.first += area * sum / 3;
  sums.second += area * (squares + sum * sum) / 12;
}

// Integrates over a triangle much longer than it is high, from base to apex: a grid of similar
// triangles would take the square of its length in samples.
void integrate_needle(const Vec3& left, const Vec3& right, const Vec3& apex, double step,
                      Probe& probe, Sums& sums) {
  const double base = (right - left).norm();
  const double height = cross(right - left, apex - left).norm() / base;
  const double strips = std::max(1.0, std::ceil(height / step));
  const auto columns = static_cast<std::size_t>(std::ceil(base / step));
  std::vector<double> last, row(columns + 1);
  for (double strip = 0; strip <= strips; ++strip) {
    const double up = strip / strips;
    const Vec3 from = left + (apex - left) * up, to = right + (apex - right) * up;
    for (std::size_t j = 0; j <= columns; ++j) {
      const double along = static_cast<double>(j) / static_cast<double>(columns);
      row[j] = probe.distance(from + (to - from) * along);
      sums.max = std::max(sums.max, row[j]);
      ++sums.samples;
    }
    // Two triangles a cell, whose bases are parts of this row and of the last.
    const double cell = base * height / (2 * strips * static_cast<double>(columns));
    for (std::size_t j = 0; j < columns && strip > 0; ++j) {
      integrate({last[j], last[j + 1], row[j]}, cell * (1 - (strip - 1) / strips), sums);
      integrate({row[j], row[j + 1], last[j + 1]}, cell * (1 - up), sums);
    }
    last = row;
  }
}

void integrate_face(const Mesh& mesh, const Triangle& t, double step, Probe& probe, Sums& sums) {
  const std::array<Vec3, 3> corners = {mesh.positions[t[0]], mesh.positions[t[1]],
                                       mesh.positions[t[2]]};
  double longest = 0;
  std::size_t base = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double length = (corners[(i + 1) % 3] - corners[i]).norm();
    if (length > longest) base = i;
    longest = std::max(longest, length);
  }
  // Below a quarter, strips take fewer samples than similar triangles.
  constexpr double kNeedle = 0.25;
  if (longest > step && 2 * triangle_area(mesh.positions, t) < kNeedle * longest * longest) {
    return integrate_needle(corners[base], corners[(base + 1) % 3], corners[(base + 2) % 3], step,
                            probe, sums);
  }
  const auto rows = static_cast<std::size_t>(std::max(1.0, std::ceil(longest / step)));
  const auto parts = static_cast<double>(rows);
  const double area = triangle_area(mesh.positions, t) / (parts * parts);
  std::vector<double> last;  // distances of the previous row, which has one sample more
  for (std::size_t i = 0; i <= rows; ++i) {
    std::vector<double> row(rows - i + 1);
    for (std::size_t j = 0; j < row.size(); ++j) {
      const double u = static_cast<double>(i) / parts;
      const double v = static_cast<double>(j) / parts;
      row[j] = probe.distance(corners[0] * (1 - u - v) + corners[1] * u + corners[2] * v);
      sums.max = std::max(sums.max, row[j]);
      ++sums.samples;
    }
    for (std::size_t j = 0; j < row.size() && i > 0; ++j) {
      integrate({last[j], last[j + 1], row[j]}, area, sums);
      if (j + 1 < row.size()) integrate({row[j], row[j + 1], last[j + 1]}, area, sums);
    }
    last = std::move(row);
  }
}

void check_faces(const Mesh& first, const Mesh& second) {
  if (first.triangles.empty() || second.triangles.empty()) {
    throw Error(ErrorCode::Usage, {}, "", "a mesh without faces has no distance to another");
  }
}

template <typename OneWay>
TwoWayStatistics both_ways(const Mesh& first, const Mesh& second, const OneWay& one_way) {
  check_faces(first, second);
  const auto towards = [&](const Mesh& from, const Mesh& to) {
    return one_way(from, SpatialIndex(to.positions, to.triangles));
  };
  return {towards(first, second), towards(second, first)};
}

}  // namespace

TwoWayStatistics metro(const Mesh& first, const Mesh& second) {
  const double target =
      10.0 * static_cast<double>(std::max(first.triangles.size(), second.triangles.size()));
  return both_ways(first, second, [&](const Mesh& from, const SpatialIndex& to) {
    return Metro(from, to, target).run();
  });
}

TwoWayStatistics mesh_distance(const Mesh& first, const Mesh& second, double step) {
  check(step > 0, "samples lie apart");
  return both_ways(first, second, [&](const Mesh& from, const SpatialIndex& to) {
    if (!(area_of(from) > 0)) throw Error(ErrorCode::Usage, {}, "", "a mesh without area");
    return fold(from.triangles.size(), to,
                [&](std::size_t t, Probe& probe, Sums& sums) {
                  integrate_face(from, from.triangles[t], step, probe, sums);
                })
        .statistics();
  });
}

}  // namespace triglyph
