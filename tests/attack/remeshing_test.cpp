// Attacks that make other triangles.
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <utility>

#include <gtest/gtest.h>

#include "engine/attack/isotropic_remesh.h"
#include "engine/attack/simplification.h"
#include "engine/attack/subdivision.h"
#include "engine/attack/voxel_remesh.h"
#include "engine/mesh/edge_length.h"
#include "engine/mesh/surface_diagonal.h"
#include "engine/metric/hausdorff.h"
#include "tests/attack/measures.h"
#include "tests/support/shapes.h"

namespace triglyph {
namespace {

using test::ball;
using test::volume_of;

double area_of(const Mesh& mesh) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles) sum += triangle_area(mesh.positions, t);
  return sum;
}

// Does every side of a triangle have exactly one that runs back?
bool is_closed_and_oriented(const Mesh& mesh) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> sides;
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (!sides.emplace(t[i], t[(i + 1) % 3]).second) return false;
    }
  }
  return std::all_of(sides.begin(), sides.end(), [&](const auto& side) {
    return sides.contains({side.second, side.first});
  });
}

// Does a side run as often one way as the other between any two points? Then no border is left,
// though more than two triangles may share an edge.
bool is_closed(const Mesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> excess;
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [low, high] = std::minmax(t[i], t[(i + 1) % 3]);
      excess[{low, high}] += t[i] == low ? 1 : -1;
    }
  }
  return std::all_of(excess.begin(), excess.end(),
                     [](const auto& side) { return side.second == 0; });
}

double distance_rel_diag(const Mesh& a, const Mesh& b) {
  const double diagonal = surface_diagonal(a);
  return hausdorff(a, b, 1e-4 * diagonal).symmetric() / diagonal;
}

TEST(Subdivision, MakesFourOrThreeTrianglesOfOne) {
  const std::size_t faces = ball().triangles.size();
  const std::size_t points = ball().positions.size();
  for (const auto subdivide : {subdivided_at_midpoints, subdivided_by_loop}) {
    const Mesh fine = subdivide(ball());
    EXPECT_EQ(fine.triangles.size(), 4 * faces);
    EXPECT_EQ(fine.positions.size(), points + faces * 3 / 2);
    EXPECT_TRUE(is_closed_and_oriented(fine));
  }
  const Mesh fine = subdivided_by_sqrt3(ball());
  EXPECT_EQ(fine.triangles.size(), 3 * faces);
  EXPECT_EQ(fine.positions.size(), points + faces);
  EXPECT_TRUE(is_closed_and_oriented(fine));
  // one triangle has three borders
  const Mesh one{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}, {{0, 1, 2}}};
  EXPECT_EQ(subdivided_by_sqrt3(one).triangles.size(), 3U);
  EXPECT_NEAR(area_of(subdivided_by_sqrt3(one)), 0.5, 1e-15);
}

TEST(Subdivision, AtMidpointsKeepsTheShapeAndLoopSmoothsIt) {
  EXPECT_NEAR(volume_of(subdivided_at_midpoints(ball())), volume_of(ball()), 1e-9);
  EXPECT_NEAR(area_of(subdivided_at_midpoints(ball())), area_of(ball()), 1e-9);
  for (const auto subdivide : {subdivided_by_loop, subdivided_by_sqrt3}) {
    const Mesh fine = subdivide(ball());
    EXPECT_LT(area_of(fine), area_of(ball()));
    EXPECT_LT(distance_rel_diag(ball(), fine), 0.02);
  }
}

// Both schemes reproduce the plane, and Loop's limit of an octahedron is known at its points: with
// four neighbours a step pulls a point by beta, 0.484375 by the formula, towards their mean.
TEST(Subdivision, HasTheWeightsOfItsAuthors) {
  const Mesh octahedron{
      {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(0, -1, 0), Vec3(0, 0, 1), Vec3(0, 0, -1)},
      {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
  EXPECT_NEAR(subdivided_by_loop(octahedron).positions[0][0], 1 - 0.484375, 1e-15);
  // the edge between (1,0,0) and (0,1,0): 3/8 of its ends, 1/8 of (0,0,1) and (0,0,-1)
  const auto fine = subdivided_by_loop(octahedron).positions;
  EXPECT_NE(std::find(fine.begin(), fine.end(), Vec3(0.375, 0.375, 0)), fine.end());
  EXPECT_NEAR(subdivided_by_sqrt3(octahedron).positions[0][0], 1 - 4.0 / 9, 1e-15);
  const Mesh plane = subdivided_by_loop(test::flat_grid(5, 5));
  EXPECT_TRUE(std::all_of(plane.positions.begin(), plane.positions.end(),
                          [](const Vec3& p) { return p[2] == 0; }));
}

TEST(Subdivision, TakesAnyTriangles) {
  // three triangles on one edge, and two that meet in a point
  const Mesh mesh{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(0, -1, 0),
                   Vec3(2, 1, 0), Vec3(2, 0, 0)},
                  {{0, 1, 2}, {0, 1, 3}, {1, 0, 4}, {1, 6, 5}}};
  EXPECT_EQ(subdivided_at_midpoints(mesh).triangles.size(), 16U);
  EXPECT_EQ(subdivided_by_loop(mesh).triangles.size(), 16U);
  EXPECT_EQ(subdivided_by_sqrt3(mesh).triangles.size(), 12U);
}

TEST(Simplification, RemovesTheShareAskedFor) {
  const auto faces = double(ball().triangles.size());
  std::set<std::array<double, 3>> points;
  for (const Vec3& p : ball().positions) points.insert(p.values);
  for (const double removed : {0.1, 0.5, 0.9, 0.975}) {
    const Mesh coarse = simplified(ball(), removed);
    EXPECT_NEAR(double(coarse.triangles.size()) / faces, 1 - removed, 0.001) << removed;
    EXPECT_TRUE(is_closed_and_oriented(coarse)) << removed;
    EXPECT_LT(distance_rel_diag(ball(), coarse), 0.05) << removed;
    for (const Vec3& p : coarse.positions) EXPECT_TRUE(points.contains(p.values));
  }
}

TEST(IsotropicRemeshing, MakesEdgesOfOneLengthOnTheSameSurface) {
  for (const double factor : {0.8, 1.0, 2.0}) {
    SCOPED_TRACE(factor);
    const double wanted = factor * mean_edge_length(ball());
    const Mesh made = remeshed_isotropically(ball(), wanted);
    EXPECT_TRUE(is_closed_and_oriented(made));
    EXPECT_NEAR(mean_edge_length(made), wanted, 0.1 * wanted);
    std::size_t fitting = 0;
    for (const Triangle& t : made.triangles) {
      for (std::size_t i = 0; i < 3; ++i) {
        const double length = (made.positions[t[i]] - made.positions[t[(i + 1) % 3]]).norm();
        fitting += length > 0.7 * wanted && length < 1.4 * wanted ? 1 : 0;
      }
    }
    EXPECT_GT(double(fitting), 0.97 * 3 * double(made.triangles.size()));
    EXPECT_LT(distance_rel_diag(ball(), made), 0.01 * factor);
    EXPECT_NEAR(volume_of(made), volume_of(ball()), 0.01 * factor * volume_of(ball()));
  }
}

TEST(IsotropicRemeshing, KeepsBordersAndTakesAnyTriangles) {
  const Mesh grid = test::flat_grid(12, 8);
  const Mesh made = remeshed_isotropically(grid, 0.7);
  EXPECT_NEAR(area_of(made), 96, 0.5);
  EXPECT_TRUE(std::all_of(made.positions.begin(), made.positions.end(),
                          [](const Vec3& p) { return std::abs(p[2]) < 1e-12; }));
  const Mesh fans{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(0, -1, 0)},
                  {{0, 1, 2}, {0, 1, 3}, {1, 0, 4}}};
  EXPECT_NEAR(area_of(remeshed_isotropically(fans, 0.2)), 1.5, 0.05);
}

TEST(VoxelRemeshing, GivesAClosedSurfaceOfTheSameSolid) {
  for (const int voxels : {32, 64}) {
    SCOPED_TRACE(voxels);
    const Mesh made = remeshed_by_voxels(ball(), voxels);
    EXPECT_TRUE(is_closed(made));
    EXPECT_NEAR(volume_of(made), volume_of(ball()), 0.01 * volume_of(ball()));
    EXPECT_LT(distance_rel_diag(ball(), made), 1.0 / voxels);
    // about a point a voxel that the surface passes
    const double side = surface_diagonal(ball()) / std::numbers::sqrt3 / voxels;
    EXPECT_NEAR(double(made.positions.size()) * side * side / area_of(ball()), 1.2, 0.5);
  }
}

TEST(VoxelRemeshing, JoinsPartsThatOverlapAndClosesSmallHoles) {
  Mesh two = ball();
  const auto first = static_cast<std::uint32_t>(two.positions.size());
  for (const Vec3& p : ball().positions) two.positions.push_back(p + Vec3(0.5, 0, 0));
  for (const Triangle& t : ball().triangles) {
    two.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  const Mesh joined = remeshed_by_voxels(two, 48);
  EXPECT_LT(volume_of(joined), 1.7 * volume_of(ball()));
  EXPECT_GT(volume_of(joined), 1.1 * volume_of(ball()));
  Mesh holed = ball();
  holed.triangles.resize(holed.triangles.size() - 40);
  EXPECT_NEAR(volume_of(remeshed_by_voxels(holed, 48)), volume_of(ball()),
              0.02 * volume_of(ball()));
  EXPECT_TRUE(remeshed_by_voxels(test::flat_grid(3, 3), 16).triangles.empty());
}

}  // namespace
}  // namespace triglyph
