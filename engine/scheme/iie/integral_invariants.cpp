// With the centre at the origin, n the outward normal of a triangle T, d its plane's signed
// distance and T' what the ball cuts from it, the divergence theorem gives
//   volume = (r^3 Omega + sum d |T'|) / 3,   area on the sphere = r^2 Omega,
// Omega the solid angle of the sphere's part inside, which is [centre inside] 4 pi less the signed
// solid angles of all T' seen from the centre. T' is cut by the circle in which the plane meets the
// ball: edge by edge, chords span triangles and arcs sectors with the circle's centre, the foot.
#include "engine/scheme/iie/integral_invariants.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "engine/base/parallel.h"

namespace triglyph {
namespace {

constexpr double kOnSurface = 1e-9;  // of the radius: nearer planes are taken to lie just outside
constexpr double kTouching = 1e-8;   // of the radius: a centre nearer to a triangle is moved inside
constexpr double kInward = 1e-7;     // of the radius, by so much
constexpr std::size_t kCentresPerTask = 16;

struct Flat {
  double x, y;
};

double turn(const Flat& a, const Flat& b) {
  return a.x * b.y - a.y * b.x;
}

double along(const Flat& a, const Flat& b) {
  return a.x * b.x + a.y * b.y;
}

// What one plane piece contributes; angles signed by the direction of its outline.
class Disc {
 public:
  // `height` > 0: of the sphere's centre over the plane.
  Disc(double radius, double height)
      : height_(height), squared_(radius * radius - height * height), cap_(1 - height / radius) {}

  // One edge of the outline, both ends relative to the foot.
  void add_edge(const Flat& from, const Flat& to) {
    const double from_squared = along(from, from);
    const double to_squared = along(to, to);
    if (from_squared <= squared_ && to_squared <= squared_) {
      add_chord(from, to);
      return;
    }
    // |from + t (to - from)|^2 = rho^2
    const Flat step{to.x - from.x, to.y - from.y};
    const double a = along(step, step);
    const double b = along(from, step);
    const double discriminant = b * b - a * (from_squared - squared_);
    if (!(discriminant > 0)) {
      add_arc(from, to);
      return;
    }
    const double root = std::sqrt(discriminant);
    const double enter = (-b - root) / a;
    const double leave = (-b + root) / a;
    if (enter >= 1 || leave <= 0) {
      add_arc(from, to);
      return;
    }
    const auto at = [&](double t) { return Flat{from.x + t * step.x, from.y + t * step.y}; };
    const Flat first = enter > 0 ? at(enter) : from;
    const Flat last = leave < 1 ? at(leave) : to;
    if (enter > 0) add_arc(from, first);
    add_chord(first, last);
    if (leave < 1) add_arc(last, to);
  }

  [[nodiscard]] double area() const { return area_; }
  [[nodiscard]] double solid_angle() const { return solid_angle_; }

 private:
  // Van Oosterom, Strackee. The solid angle of a plane triangle (1983), for one whose first corner
  // is the foot.
  void add_chord(const Flat& from, const Flat& to) {
    const double cross = turn(from, to);
    const double h = height_;
    const double p = std::sqrt(along(from, from) + h * h);
    const double q = std::sqrt(along(to, to) + h * h);
    area_ += cross / 2;
    solid_angle_ += 2 * std::atan2(cross, p * q + h * (p + q) + along(from, to) + h * h);
  }

  void add_arc(const Flat& from, const Flat& to) {
    const double angle = std::atan2(turn(from, to), along(from, to));
    area_ += squared_ * angle / 2;
    solid_angle_ += angle * cap_;
  }

  double height_;
  double squared_;  // of the circle's radius
  double cap_;      // solid angle of a sector over its angle
  double area_ = 0;
  double solid_angle_ = 0;
};

// Of a whole triangle, seen from the origin; `squares` of its corners' distances.
// Van Oosterom, Strackee (1983).
double solid_angle_of(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& squares,
                      double six_volumes) {
  const double p = std::sqrt(squares[0]), q = std::sqrt(squares[1]), r = std::sqrt(squares[2]);
  return 2 * std::atan2(six_volumes, p * q * r + dot(a, b) * r + dot(a, c) * q + dot(b, c) * p);
}

// A centre on the surface sees the triangles it lies on from their edge, which tells nothing; one
// just inside sees them as they are.
Vec3 off_the_surface(std::span<const Vec3> positions, std::span<const Triangle> mesh,
                     std::span<const std::uint32_t> triangles, const Vec3& centre, double radius) {
  const double near = kTouching * radius;
  Vec3 outward(0, 0, 0);
  for (const std::uint32_t index : triangles) {
    const Vec3& a = positions[mesh[index][0]];
    const Vec3& b = positions[mesh[index][1]];
    const Vec3& c = positions[mesh[index][2]];
    const Vec3 normal = area_normal(a, b, c);
    const double twice_area = normal.norm();
    if (!(twice_area > 0) || std::abs(dot(normal, a - centre)) > near * twice_area) continue;
    if ((closest_on_triangle(centre, a, b, c) - centre).norm() > near) continue;
    outward += normal / twice_area;
  }
  const double length = outward.norm();
  return length > 0 ? centre - outward * (kInward * radius / length) : centre;
}

}  // namespace

BallInvariants ball_invariants(std::span<const Vec3> positions, std::span<const Triangle> mesh,
                               std::span<const std::uint32_t> triangles, const Vec3& ideal_centre,
                               double radius) {
  const Vec3 centre = off_the_surface(positions, mesh, triangles, ideal_centre, radius);
  const double squared_radius = radius * radius;
  double solid_angle = 0;  // of all T', signed
  double cones = 0;        // sum of d |T'|
  for (const std::uint32_t index : triangles) {
    const Vec3 a = positions[mesh[index][0]] - centre;
    const Vec3 b = positions[mesh[index][1]] - centre;
    const Vec3 c = positions[mesh[index][2]] - centre;
    const Vec3 ab = b - a;
    const Vec3 area_vector = cross(ab, c - a);
    const double twice_area = area_vector.norm();
    const double six_volumes = dot(area_vector, a);
    const Vec3 squares(a.sqrnorm(), b.sqrnorm(), c.sqrnorm());
    if (squares.max() <= squared_radius &&
        std::abs(six_volumes) > kOnSurface * radius * twice_area) {
      solid_angle += solid_angle_of(a, b, c, squares, six_volumes);
      cones += six_volumes / 2;
      continue;
    }
    const double base = ab.norm();
    if (!(twice_area > 0 && base > 0)) continue;
    const Vec3 normal = area_vector / twice_area;
    const double distance = dot(normal, a);
    if (std::abs(distance) >= radius) continue;
    const double side = distance > -kOnSurface * radius ? 1 : -1;
    const Vec3 x_axis = ab / base;
    const Vec3 y_axis = cross(normal, x_axis);
    const auto flat = [&](const Vec3& p) { return Flat{dot(x_axis, p), dot(y_axis, p)}; };
    const Flat corners[3] = {flat(a), flat(b), flat(c)};
    Disc disc(radius, std::max(std::abs(distance), kOnSurface * radius));
    for (std::size_t i = 0; i < 3; ++i) disc.add_edge(corners[i], corners[(i + 1) % 3]);
    solid_angle += side * disc.solid_angle();
    cones += distance * disc.area();
  }
  // a share lies between 0 and 1, so the sign tells whether the centre is inside
  double share = -solid_angle / (4 * std::numbers::pi);
  if (solid_angle > 0) share += 1;
  const double ball = 4 * std::numbers::pi * radius * radius * radius;
  return {share, share + cones / ball};
}

std::vector<BallInvariants> all_ball_invariants(
    std::span<const Vec3> positions, std::span<const Triangle> mesh, const SpatialIndex& index,
    std::span<const char> unfit, std::span<const Vec3> centres, double radius, std::size_t most) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  std::vector<BallInvariants> invariants(centres.size(), {kNone, kNone});
  parallel_for(
      centres.size(),
      [&](std::size_t i) {
        const auto near = index.triangles_in_ball(centres[i], radius, most);
        if (!near || near->empty()) return;
        const bool is_fit = std::none_of(near->begin(), near->end(),
                                         [&](std::uint32_t t) { return unfit[t] != 0; });
        if (is_fit) invariants[i] = ball_invariants(positions, mesh, *near, centres[i], radius);
      },
      kCentresPerTask);
  return invariants;
}

}  // namespace triglyph
