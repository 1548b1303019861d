#include "engine/scheme/iie/local_ball.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "engine/geometry/triangle.h"
#include "engine/scheme/iie/ball.h"
#include "engine/scheme/iie/integral_invariants.h"
#include "engine/scheme/iie/sites.h"

namespace triglyph {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// The edges of the points within so many rings tell the size of the edges about a site: some 100,
// so that noise on them averages out, and none far outside the ball.
constexpr int kScaleRings = 2;
// Of the radius: room for triangles that a bump brings into the ball.
constexpr double kLocalMargin = 0.04;
// Of the radius: so far the bump reaches.
constexpr double kReach = 0.85;
// Of the radius: a bump this high is as steep as one wants to see on no surface.
constexpr double kLocalMaxHeight = 0.05;
// Regula falsi takes about six steps; this many are used up only where there is no root.
constexpr int kLocalMaxRefinements = 40;
// Of a share: a millionth of a cell, and far above what double precision makes of it.
constexpr double kSharePrecision = 1e-9;

// 1 at the centre and 0 from the reach on, with its slope.
double bump_profile(double distance, double radius) {
  const double s = distance / (kReach * radius);
  return s < 1 ? (1 - s * s) * (1 - s * s) : 0;
}

std::optional<std::vector<std::uint32_t>> triangles_about(const LocalGround& ground,
                                                          const Sphere& sphere, double margin) {
  auto near = ground.index.triangles_in_ball(sphere.centre, sphere.radius * (1 + margin),
                                             most_triangles_in(sphere.radius, sphere.edge));
  if (!near || near->empty()) return std::nullopt;
  const bool at_boundary = std::any_of(near->begin(), near->end(),
                                       [&](std::uint32_t t) { return ground.at_boundary[t] != 0; });
  if (at_boundary) return std::nullopt;
  return near;
}

double crossed(double share) {
  return share > 0 && share < 1 ? share : kNone;
}

}  // namespace

std::optional<SphereFrame> sphere_frame(const LocalGround& ground, std::uint32_t anchor) {
  const Halfedges& halfedges = ground.surface.halfedges;
  auto centre_points = points_within(halfedges, anchor, ground.centre_rings);
  const auto about = points_within(halfedges, anchor, kScaleRings);
  if (!centre_points || !about) return std::nullopt;
  SphereFrame frame{std::move(*centre_points), {}};
  for (const std::uint32_t point : *about) {
    const bool closed = visit_ring(halfedges, point, [&](std::uint32_t other) {
      frame.edges_about.push_back({point, other});
    });
    if (!closed) return std::nullopt;
  }
  return frame;
}

Sphere sphere_of(const SphereFrame& frame, std::span<const Vec3> positions,
                 const LocalGround& ground) {
  Sphere sphere;
  for (const std::uint32_t point : frame.centre_points) sphere.centre += positions[point];
  sphere.centre /= static_cast<double>(frame.centre_points.size());
  for (const auto& [from, to] : frame.edges_about) {
    sphere.edge += (positions[to] - positions[from]).norm();
  }
  sphere.edge /= static_cast<double>(frame.edges_about.size());
  sphere.radius = ground.radius > 0 ? ground.radius : ground.radius_edges * sphere.edge;
  return sphere;
}

double sphere_share(const LocalGround& ground, std::uint32_t anchor) {
  const auto frame = sphere_frame(ground, anchor);
  if (!frame) return kNone;
  const Mesh& mesh = ground.surface.mesh;
  const Sphere sphere = sphere_of(*frame, mesh.positions, ground);
  if (!(sphere.edge > 0)) return kNone;
  const auto near = triangles_about(ground, sphere, 0);
  if (!near) return kNone;
  return crossed(
      ball_invariants(mesh.positions, mesh.triangles, *near, sphere.centre, sphere.radius).area);
}

std::optional<LocalBall> LocalBall::at(const LocalGround& ground, std::uint32_t anchor) {
  auto frame = sphere_frame(ground, anchor);
  if (!frame) return std::nullopt;
  const Mesh& mesh = ground.surface.mesh;
  const Sphere sphere = sphere_of(*frame, mesh.positions, ground);
  if (!(sphere.edge > 0)) return std::nullopt;
  const auto near = triangles_about(ground, sphere, kLocalMargin);
  if (!near) return std::nullopt;

  LocalBall ball;
  ball.ground_ = &ground;
  ball.max_height_ = kLocalMaxHeight * sphere.radius;
  for (const std::uint32_t t : *near) {
    const Triangle& corners = mesh.triangles[t];
    ball.points_.insert(ball.points_.end(), corners.begin(), corners.end());
  }
  for (const auto& [from, to] : frame->edges_about) ball.points_.push_back(to);
  std::sort(ball.points_.begin(), ball.points_.end());
  ball.points_.erase(std::unique(ball.points_.begin(), ball.points_.end()), ball.points_.end());
  const auto local = [&](std::uint32_t point) {
    const auto at = std::lower_bound(ball.points_.begin(), ball.points_.end(), point);
    return static_cast<std::uint32_t>(at - ball.points_.begin());
  };
  for (const std::uint32_t point : ball.points_) ball.positions_.push_back(mesh.positions[point]);
  for (const std::uint32_t t : *near) {
    const Triangle& corners = mesh.triangles[t];
    ball.triangles_.push_back({local(corners[0]), local(corners[1]), local(corners[2])});
  }
  ball.all_.resize(ball.triangles_.size());
  std::iota(ball.all_.begin(), ball.all_.end(), 0U);

  // the bump spreads from the anchor, so that it never takes another sheet along
  ball.profile_.assign(ball.points_.size(), 0);
  std::vector<std::uint32_t> queue{anchor};
  ball.profile_[local(anchor)] =
      bump_profile((mesh.positions[anchor] - sphere.centre).norm(), sphere.radius);
  if (!(ball.profile_[local(anchor)] > 0)) return std::nullopt;
  for (std::size_t next = 0; next < queue.size(); ++next) {
    const bool closed = visit_ring(ground.surface.halfedges, queue[next], [&](std::uint32_t other) {
      double& profile = ball.profile_[local(other)];
      if (profile > 0) return;
      profile = bump_profile((mesh.positions[other] - sphere.centre).norm(), sphere.radius);
      if (profile > 0) queue.push_back(other);
    });
    if (!closed) return std::nullopt;
  }
  for (const Triangle& t : ball.triangles_) {
    const double weight = ball.profile_[t[0]] + ball.profile_[t[1]] + ball.profile_[t[2]];
    ball.normal_ += area_normal(ball.positions_, t) * weight;
  }
  const double length = ball.normal_.norm();
  if (!(length > 0)) return std::nullopt;
  ball.normal_ /= length;

  for (std::uint32_t& point : frame->centre_points) point = local(point);
  for (auto& edge : frame->edges_about) edge = {local(edge[0]), local(edge[1])};
  ball.frame_ = std::move(*frame);
  if (!std::isfinite(ball.share(0))) return std::nullopt;
  return ball;
}

std::vector<std::uint32_t> LocalBall::moved() const {
  std::vector<std::uint32_t> moved;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (profile_[i] > 0) moved.push_back(points_[i]);
  }
  return moved;
}

double LocalBall::greatest_profile() const {
  return *std::max_element(profile_.begin(), profile_.end());
}

double LocalBall::rms_profile() const {
  double squares = 0, count = 0;
  for (const double profile : profile_) {
    squares += profile * profile;
    count += profile > 0 ? 1 : 0;
  }
  return std::sqrt(squares / count);
}

double LocalBall::share(double height) const {
  std::vector<Vec3> positions = positions_;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    positions[i] += normal_ * (profile_[i] * height);
  }
  const Sphere sphere = sphere_of(frame_, positions, *ground_);
  return crossed(ball_invariants(positions, triangles_, all_, sphere.centre, sphere.radius).area);
}

double LocalBall::height_of(std::size_t sample) const {
  return max_height_ * (2.0 * static_cast<double>(sample) / (kSamples - 1) - 1);
}

std::optional<double> LocalBall::height_for(double wanted) {
  if (!is_sampled_) {
    for (std::size_t i = 0; i < kSamples; ++i) samples_[i] = share(height_of(i));
    is_sampled_ = true;
  }
  constexpr std::size_t kMiddle = (kSamples - 1) / 2;
  for (std::size_t away = 0; away < kMiddle; ++away) {
    for (const std::size_t first : {kMiddle + away, kMiddle - away - 1}) {
      const double here = samples_[first] - wanted;
      const double there = samples_[first + 1] - wanted;
      if (!(here * there <= 0) || here == there) continue;  // a NaN crosses nothing
      const double from = height_of(first);
      return from + (height_of(first + 1) - from) * here / (here - there);
    }
  }
  return std::nullopt;
}

// Regula falsi (Illinois) about the planned height.
std::optional<double> LocalBall::refined(double planned, double wanted) const {
  const double spacing = height_of(1) - height_of(0);
  double low = planned - spacing, high = planned + spacing;
  double at_low = share(low) - wanted, at_high = share(high) - wanted;
  if (!(at_low * at_high <= 0)) return std::nullopt;
  double height = planned;
  int same_side = 0;
  for (int step = 0; step < kLocalMaxRefinements; ++step) {
    const double excess = share(height) - wanted;
    if (!std::isfinite(excess)) return std::nullopt;
    if (std::abs(excess) < kSharePrecision) return height;
    const bool replaces_low = excess * at_high < 0;
    (replaces_low ? low : high) = height;
    (replaces_low ? at_low : at_high) = excess;
    same_side = replaces_low ? std::max(1, same_side + 1) : std::min(-1, same_side - 1);
    if (same_side > 1) at_high /= 2;
    if (same_side < -1) at_low /= 2;
    height = (low * at_high - high * at_low) / (at_high - at_low);
  }
  return height;
}

}  // namespace triglyph
