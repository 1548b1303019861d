#include "engine/scheme/iie/ball.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <unordered_set>

#include "engine/scheme/iie/sites.h"

namespace triglyph {
namespace {

// Of the radius: room for triangles that a shift of the centre brings into the ball, and within
// which no point of the cap may lie.
constexpr double kMargin = 0.02;
// Of the radius: so far the cap moves as one, and from there to the sphere ever less.
constexpr double kFlatCap = 0.5;
// Of the radius, of the centre: so far the table reaches either way.
constexpr double kMaxShift = 0.25;
// Regula falsi wants about ten steps; this many are used up only where the area has no root.
constexpr int kMaxRefinements = 40;
// Of a share: what double precision leaves of it after a few hundred triangles.
constexpr double kAreaPrecision = 1e-13;
// See most_triangles_in.
constexpr double kCrowd = 100;
constexpr double kMostTriangles = 1e9;  // still a number of triangles when doubled

// Falls smoothly from 1 within kFlatCap of the radius to 0 at the radius.
double cap_profile(double distance, double radius) {
  const double s = std::max(0.0, (distance / radius - kFlatCap) / (1 - kFlatCap));
  return s < 1 ? (1 - s * s) * (1 - s * s) : 0;
}

// Area vectors of the triangles around a point, added up.
Vec3 fan_area(const Surface& surface, std::uint32_t point) {
  const Vec3& apex = surface.mesh.positions[point];
  Vec3 sum(0, 0, 0), first(0, 0, 0), last(0, 0, 0);
  bool started = false;
  visit_ring(surface.halfedges, point, [&](std::uint32_t other) {
    const Vec3 arm = surface.mesh.positions[other] - apex;
    if (started) sum += cross(last, arm);
    if (!started) first = arm;
    started = true;
    last = arm;
  });
  return (sum + cross(last, first)) * 0.5;
}

// Points reached from the anchor whose triangles all lie well within the ball, ascending.
std::vector<std::uint32_t> cap_of(const BallGround& ground, std::uint32_t anchor,
                                  const Vec3& centre) {
  const Surface& surface = ground.surface;
  const double inside = ground.radius * (1 - kMargin);
  const auto lies_inside = [&](std::uint32_t point) {
    return (surface.mesh.positions[point] - centre).sqrnorm() < inside * inside;
  };
  std::vector<std::uint32_t> cap;
  std::unordered_set<std::uint32_t> seen{anchor};
  std::vector<std::uint32_t> queue{anchor};
  std::vector<std::uint32_t> ring;
  for (std::size_t next = 0; next < queue.size(); ++next) {
    ring.clear();
    const bool closed = visit_ring(surface.halfedges, queue[next],
                                   [&](std::uint32_t other) { ring.push_back(other); });
    if (!closed || !std::all_of(ring.begin(), ring.end(), lies_inside)) continue;
    cap.push_back(queue[next]);
    for (const std::uint32_t other : ring) {
      if (seen.insert(other).second) queue.push_back(other);
    }
  }
  std::sort(cap.begin(), cap.end());
  return cap;
}

// How far each point of the cap follows a move, and what that does to the centre.
void weigh_cap(const BallGround& ground, std::span<const std::uint32_t> centre_points, Ball& ball) {
  for (const std::uint32_t point : ball.cap) {
    const double distance = (ground.surface.mesh.positions[point] - ball.centre).norm();
    const double profile = cap_profile(distance, ground.radius);
    const bool is_centres = std::binary_search(centre_points.begin(), centre_points.end(), point);
    ball.profile.push_back(profile);
    ball.swept.push_back(profile * dot(fan_area(ground.surface, point), ball.normal));
    ball.is_centres.push_back(is_centres ? 1 : 0);
    (is_centres ? ball.squares_inner : ball.squares_outer) += profile * profile;
    double& most = is_centres ? ball.most_inner : ball.most_outer;
    most = std::max(most, profile);
    if (is_centres) ball.centre_gain += profile / static_cast<double>(centre_points.size());
  }
}

}  // namespace

Vec3 BallGround::mean_of(std::span<const std::uint32_t> points) const {
  Vec3 sum(0, 0, 0);
  for (const std::uint32_t point : points) sum += surface.mesh.positions[point];
  return sum / static_cast<double>(points.size());
}

// A regular mesh has about 7 (r / e)^2 triangles in a ball; where there are far more, points lie in
// heaps, and to look at all of them from all of them would take for ever.
std::size_t most_triangles_in(double radius, double edge) {
  const double share = edge > 0 ? radius / edge : 0;
  // in this order, a share that is no number gives the limit
  return static_cast<std::size_t>(std::min(kMostTriangles, kCrowd * share * share));
}

double Ball::farthest(const CapMoves& moves) const {
  return std::max(most_inner * std::abs(moves.all), most_outer * std::abs(moves.all + moves.outer));
}

double Ball::rms(const CapMoves& moves) const {
  const double outer = moves.all + moves.outer;
  return std::sqrt((squares_inner * moves.all * moves.all + squares_outer * outer * outer) /
                   static_cast<double>(cap.size()));
}

bool Ball::set_lifts(double read_radius) {
  const double volume = 4.0 / 3.0 * std::numbers::pi * std::pow(read_radius, 3);
  lift_all = 0;
  lift_outer = 0;
  for (std::size_t i = 0; i < cap.size(); ++i) {
    const double lift = swept[i] / (3 * volume);
    lift_all += lift;
    if (is_centres[i] == 0) lift_outer += lift;
  }
  return lift_outer > 0 && lift_all > 0;
}

std::optional<Ball> ball_at(const BallGround& ground, std::uint32_t anchor) {
  const auto centre_points = points_within(ground.surface.halfedges, anchor, ground.centre_rings);
  if (!centre_points) return std::nullopt;
  Ball ball;
  ball.radius = ground.radius;
  ball.centre = ground.mean_of(*centre_points);
  for (const std::uint32_t point : *centre_points) ball.normal += fan_area(ground.surface, point);
  const double length = ball.normal.norm();
  if (!(length > 0)) return std::nullopt;
  ball.normal /= length;

  auto near = ground.index.triangles_in_ball(ball.centre, ground.radius * (1 + kMargin),
                                             ground.most_triangles);
  if (!near) return std::nullopt;
  ball.near = std::move(*near);
  const bool at_boundary = std::any_of(ball.near.begin(), ball.near.end(),
                                       [&](std::uint32_t t) { return ground.at_boundary[t] != 0; });
  if (at_boundary) return std::nullopt;

  ball.cap = cap_of(ground, anchor, ball.centre);
  if (!std::includes(ball.cap.begin(), ball.cap.end(), centre_points->begin(),
                     centre_points->end())) {
    return std::nullopt;
  }
  weigh_cap(ground, *centre_points, ball);
  if (!ball.set_lifts(ground.radius)) return std::nullopt;
  return ball;
}

std::optional<SampledBall> SampledBall::at(const BallGround& ground, std::uint32_t anchor) {
  std::optional<Ball> ball = ball_at(ground, anchor);
  if (!ball) return std::nullopt;
  auto near = ground.index.triangles_in_ball(ball->centre, ball->radius * (1 + kMaxShift),
                                             2 * ground.most_triangles);
  if (!near) return std::nullopt;
  ball->near = std::move(*near);
  return SampledBall(ground.surface, std::move(*ball));
}

bool SampledBall::set_read_radius(double radius) {
  if (radius != read_radius_) known_.reset();
  read_radius_ = radius;
  return ball_.set_lifts(radius);
}

BallInvariants SampledBall::exact(double shift) const {
  return ball_invariants(surface_->mesh.positions, surface_->mesh.triangles, ball_.near,
                         ball_.centre + ball_.normal * shift, read_radius_);
}

double SampledBall::shift_of(std::size_t sample) const {
  const double place = 2.0 * static_cast<double>(sample) / (kSamples - 1) - 1;
  return kMaxShift * ball_.radius * place;
}

const BallInvariants& SampledBall::sample(std::size_t i) {
  if (!known_[i]) samples_[i] = exact(shift_of(i));
  known_[i] = true;
  return samples_[i];
}

BallInvariants SampledBall::interpolated(double shift) {
  const double place = (shift / (kMaxShift * ball_.radius) + 1) / 2 * (kSamples - 1);
  const auto below = static_cast<std::size_t>(std::clamp(place, 0.0, kSamples - 1.001));
  const double t = place - static_cast<double>(below);
  const BallInvariants& a = sample(below);
  const BallInvariants& b = sample(below + 1);
  return {a.area + t * (b.area - a.area), a.volume + t * (b.volume - a.volume)};
}

std::optional<double> SampledBall::shift_for_area(double area) {
  constexpr std::size_t kMiddle = (kSamples - 1) / 2;
  for (std::size_t away = 0; away < kMiddle; ++away) {
    for (const std::size_t first : {kMiddle + away, kMiddle - away - 1}) {
      const double here = sample(first).area - area;
      const double there = sample(first + 1).area - area;
      if (here * there > 0 || here == there) continue;
      const double from = shift_of(first);
      const double to = shift_of(first + 1);
      return from + (to - from) * here / (here - there);
    }
  }
  return std::nullopt;
}

CapMoves SampledBall::moves_to(double shift, double volume, double wanted) const {
  CapMoves moves;
  moves.all = shift / ball_.centre_gain;
  moves.outer = (wanted - volume - moves.all * ball_.lift_all) / ball_.lift_outer;
  return moves;
}

// Regula falsi (Illinois) about the planned shift.
std::optional<CapMoves> SampledBall::refined(double planned_shift, double area,
                                             double wanted_volume) const {
  const auto excess = [&](double shift) { return exact(shift).area - area; };
  const double spacing = 2 * kMaxShift * ball_.radius / (kSamples - 1);
  double low = planned_shift - spacing, high = planned_shift + spacing;
  double at_low = excess(low), at_high = excess(high);
  if (at_low * at_high > 0) return std::nullopt;
  double shift = planned_shift;
  int same_side = 0;
  // the last invariants worked out, which are most often those of the root
  double worked_out = std::numeric_limits<double>::quiet_NaN();
  double volume = 0;
  for (int step = 0; step < kMaxRefinements; ++step) {
    const BallInvariants here = exact(shift);
    worked_out = shift;
    volume = here.volume;
    const double value = here.area - area;
    if (std::abs(value) < kAreaPrecision) break;
    const bool replaces_low = value * at_high < 0;
    (replaces_low ? low : high) = shift;
    (replaces_low ? at_low : at_high) = value;
    same_side = replaces_low ? std::max(1, same_side + 1) : std::min(-1, same_side - 1);
    if (same_side > 1) at_high /= 2;
    if (same_side < -1) at_low /= 2;
    shift = (low * at_high - high * at_low) / (at_high - at_low);
  }
  if (shift != worked_out) volume = exact(shift).volume;
  return moves_to(shift, volume, wanted_volume);
}

}  // namespace triglyph
