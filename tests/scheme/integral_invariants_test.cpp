#include "engine/scheme/iie/integral_invariants.h"

#include <cmath>
#include <numbers>
#include <numeric>

#include <gtest/gtest.h>

#include "engine/base/random.h"
#include "engine/geometry/spatial_index.h"
#include "engine/mesh/edge_length.h"
#include "tests/support/arenas.h"
#include "tests/support/attacks.h"
#include "tests/support/shapes.h"

namespace triglyph {
namespace {

BallInvariants invariants_at(const Mesh& mesh, const Vec3& centre, double radius) {
  std::vector<std::uint32_t> all(mesh.triangles.size());
  std::iota(all.begin(), all.end(), 0U);
  return ball_invariants(mesh.positions, mesh.triangles, all, centre, radius);
}

// A box with sides 2, 3, 4, one corner at the origin, the others in the positive octant.
Mesh box() {
  Mesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.positions.emplace_back((i & 1) * 2.0, (i >> 1 & 1) * 3.0, (i >> 2) * 4.0);
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

// Octahedron, every face cut in four `times` times, on the unit sphere.
Mesh sphere(int times) {
  Mesh mesh;
  mesh.positions = {Vec3(1, 0, 0),  Vec3(0, 1, 0),  Vec3(0, 0, 1),
                    Vec3(-1, 0, 0), Vec3(0, -1, 0), Vec3(0, 0, -1)};
  mesh.triangles = {{0, 1, 2}, {1, 3, 2}, {3, 4, 2}, {4, 0, 2},
                    {1, 0, 5}, {3, 1, 5}, {4, 3, 5}, {0, 4, 5}};
  for (int i = 0; i < times; ++i) {
    std::vector<Triangle> finer;
    for (const Triangle& t : mesh.triangles) {
      std::array<std::uint32_t, 3> middle{};
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 sum = mesh.positions[t[k]] + mesh.positions[t[(k + 1) % 3]];
        middle[k] = static_cast<std::uint32_t>(mesh.positions.size());
        mesh.positions.push_back(sum / sum.norm());
      }
      finer.push_back({t[0], middle[0], middle[2]});
      finer.push_back({middle[0], t[1], middle[1]});
      finer.push_back({middle[2], middle[1], t[2]});
      finer.push_back({middle[0], middle[1], middle[2]});
    }
    mesh.triangles = finer;
  }
  return mesh;
}

TEST(BallInvariants, OfAFaceAnEdgeAndACornerOfABox) {
  const Mesh mesh = box();
  for (const double radius : {0.1, 0.5, 0.9}) {
    const auto face = invariants_at(mesh, Vec3(1, 1.5, 0), radius);
    EXPECT_NEAR(face.area, 0.5, 1e-6);
    EXPECT_NEAR(face.volume, 0.5, 1e-6);
    const auto edge = invariants_at(mesh, Vec3(1, 0, 0), radius);
    EXPECT_NEAR(edge.area, 0.25, 1e-6);
    EXPECT_NEAR(edge.volume, 0.25, 1e-6);
    const auto corner = invariants_at(mesh, Vec3(0, 0, 0), radius);
    EXPECT_NEAR(corner.area, 0.125, 1e-6);
    EXPECT_NEAR(corner.volume, 0.125, 1e-6);
  }
}

// A cap: a plane at signed distance h from the centre leaves (1 + h/r) / 2 of the sphere and
// (2 + 3 h/r - (h/r)^3) / 4 of the ball.
TEST(BallInvariants, OfACentreBesideAPlane) {
  const Mesh mesh = box();
  for (const double height : {0.4, 0.1, 1e-3, -1e-3, -0.2, -0.45}) {
    const double radius = 0.5;
    const double x = height / radius;
    const auto found = invariants_at(mesh, Vec3(1.1, 1.4, height), radius);
    EXPECT_NEAR(found.area, (1 + x) / 2, 1e-12);
    EXPECT_NEAR(found.volume, (2 + 3 * x - x * x * x) / 4, 1e-12);
  }
}

TEST(BallInvariants, OfASphere) {
  const Mesh mesh = sphere(6);
  for (const double radius : {0.2, 0.5}) {
    for (const double depth : {0.0, 0.05, -0.05}) {
      const double t = 1 - depth;
      const double cosine = (1 - t * t - radius * radius) / (2 * radius * t);
      const Vec3 direction = Vec3(0.3, -0.5, 0.7) / Vec3(0.3, -0.5, 0.7).norm();
      const auto found = invariants_at(mesh, direction * t, radius);
      EXPECT_NEAR(found.area, (1 + cosine) / 2, 1e-3);
      // lens of two balls: Weisstein, Sphere-Sphere Intersection
      const double lens = std::numbers::pi * std::pow(1 + radius - t, 2) *
                          (t * t + 2 * t * radius - 3 * radius * radius + 2 * t + 6 * radius - 3) /
                          (12 * t);
      const double ball = 4.0 / 3.0 * std::numbers::pi * std::pow(radius, 3);
      EXPECT_NEAR(found.volume, lens / ball, 1e-3);
    }
  }
}

TEST(BallInvariants, WithinOrOutsideAreOneAndNothing) {
  const Mesh mesh = box();
  const auto inside = invariants_at(mesh, Vec3(1, 1.5, 2), 0.5);
  EXPECT_NEAR(inside.area + inside.volume, 2 * inside.area, 1e-12);
  const auto thin = invariants_at(mesh, Vec3(1, 1.5, 2), 1.2);  // two sheets: the box is 2 wide
  EXPECT_NEAR(thin.area, 1 / 1.2, 1e-12);
}

TEST(BallInvariants, VolumeGrowsByTheArea) {
  const Mesh& mesh = test::bumpy_ball().mesh;
  const double edge = mean_edge_length(mesh);
  for (std::size_t i = 0; i < mesh.positions.size(); i += 500) {
    const Vec3 centre = mesh.positions[i] * 0.99;
    const double r = 4 * edge, step = 1e-4 * r;
    const auto volume = [&](double radius) {
      return invariants_at(mesh, centre, radius).volume * std::pow(radius, 3) / 3;
    };
    EXPECT_NEAR((volume(r + step) - volume(r - step)) / (2 * step),
                invariants_at(mesh, centre, r).area * r * r, 1e-6 * r * r);
  }
}

// Is a point inside? By the parity of crossings along a ray.
bool lies_inside(const Mesh& mesh, const Vec3& point) {
  const Vec3 direction(0.2987, 0.8132, 0.4997);
  int crossings = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 a = mesh.positions[t[0]], ab = mesh.positions[t[1]] - a;
    const Vec3 ac = mesh.positions[t[2]] - a;
    const Vec3 p = cross(direction, ac);
    const double determinant = dot(ab, p);
    const double u = dot(point - a, p) / determinant;
    const Vec3 q = cross(point - a, ab);
    const double v = dot(direction, q) / determinant;
    if (u >= 0 && v >= 0 && u + v <= 1 && dot(ac, q) / determinant > 0) ++crossings;
  }
  return crossings % 2 == 1;
}

TEST(BallInvariants, AgreeWithMonteCarloOnANonConvexMesh) {
  const Mesh mesh = make_sample_shape(SampleShape::HighGenus, 2000, 3);
  constexpr int kDarts = 4000;
  const double radius = 5 * mean_edge_length(mesh);
  for (std::uint64_t k = 0; k < 6; ++k) {
    const Vec3 centre = mesh.positions[(k * 137) % mesh.positions.size()] + Vec3(1e-3, 2e-3, 3e-3);
    int on_sphere = 0, in_ball = 0;
    for (std::uint64_t i = 0; i < kDarts; ++i) {
      const double z = 2 * random_unit(k, 0, i) - 1,
                   turn = 2 * std::numbers::pi * random_unit(k, 1, i);
      const double flat = std::sqrt(1 - z * z);
      const Vec3 direction(flat * std::cos(turn), flat * std::sin(turn), z);
      on_sphere += lies_inside(mesh, centre + direction * radius) ? 1 : 0;
      in_ball += lies_inside(mesh, centre + direction * (radius * std::cbrt(random_unit(k, 2, i))))
                     ? 1
                     : 0;
    }
    const auto found = invariants_at(mesh, centre, radius);
    const double three_sigma = 3 * 0.5 / std::sqrt(kDarts) + 1e-3;
    EXPECT_NEAR(found.area, static_cast<double>(on_sphere) / kDarts, three_sigma);
    EXPECT_NEAR(found.volume, static_cast<double>(in_ball) / kDarts, three_sigma);
  }
}

TEST(BallInvariants, InsideOutGivesTheRest) {
  Mesh mesh = test::bumpy_ball().mesh;
  const Vec3 centre = mesh.positions[77] * 0.995;
  const double radius = 4 * mean_edge_length(mesh);
  const auto before = invariants_at(mesh, centre, radius);
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  const auto after = invariants_at(mesh, centre, radius);
  EXPECT_NEAR(before.area + after.area, 1, 1e-12);
  EXPECT_NEAR(before.volume + after.volume, 1, 1e-12);
}

TEST(AllBallInvariants, AreThoseOfEachAndSkipTheUnfit) {
  const Mesh& mesh = test::bumpy_ball().mesh;
  const double radius = 4 * mean_edge_length(mesh);
  std::vector<char> unfit(mesh.triangles.size(), 0);
  unfit[100] = 1;
  const SpatialIndex index(mesh.positions, mesh.triangles);
  test::expect_same_for_any_threads([&] {
    std::vector<double> flat;
    for (const BallInvariants& found : all_ball_invariants(mesh.positions, mesh.triangles, index,
                                                           unfit, mesh.positions, radius, 5000)) {
      flat.push_back(std::isnan(found.area) ? -1 : found.area);
      flat.push_back(std::isnan(found.volume) ? -1 : found.volume);
    }
    return flat;
  });
  const auto all = all_ball_invariants(mesh.positions, mesh.triangles, index, unfit, mesh.positions,
                                       radius, 5000);
  const Triangle& bad = mesh.triangles[100];
  std::size_t skipped = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Vec3& centre = mesh.positions[i];
    const double distance = (closest_on_triangle(centre, mesh.positions[bad[0]],
                                                 mesh.positions[bad[1]], mesh.positions[bad[2]]) -
                             centre)
                                .norm();
    EXPECT_EQ(std::isnan(all[i].area), distance <= radius);
    skipped += std::isnan(all[i].area) ? 1 : 0;
    if (i % 500 != 0 || distance <= radius) continue;
    const auto one = invariants_at(mesh, centre, radius);
    EXPECT_NEAR(all[i].area, one.area, 1e-12);
    EXPECT_NEAR(all[i].volume, one.volume, 1e-12);
  }
  EXPECT_GT(skipped, 20U);
}

TEST(AllBallInvariants, DegenerateTrianglesCountNothing) {
  Mesh mesh = box();
  mesh.positions.emplace_back(1, 1.5, 0);
  mesh.triangles.push_back({0, 8, 3});
  const auto found = invariants_at(mesh, Vec3(1, 1.5, 0.1), 0.5);
  EXPECT_NEAR(found.area, 0.6, 1e-12);
}

}  // namespace
}  // namespace triglyph
