#include "engine/metric/hausdorff.h"

#include <array>
#include <limits>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "engine/base/random.h"
#include "engine/geometry/box.h"
#include "engine/geometry/spatial_index.h"
#include "engine/mesh/surface_diagonal.h"
#include "engine/metric/deformation.h"
#include "tests/support/arenas.h"
#include "tests/support/remeshing.h"
#include "tests/support/shapes.h"

namespace triglyph {
namespace {

constexpr double kTolerance = 1e-7;

Vec3 random_point(std::uint64_t seed, std::uint64_t i, double size) {
  return Vec3(random_unit(seed, 0, i) - 0.5, random_unit(seed, 1, i) - 0.5,
              random_unit(seed, 2, i) - 0.5) *
         size;
}

TEST(ClosestOnTriangle, NoPointOfTheTriangleIsNearer) {
  for (std::uint64_t i = 0; i < 300; ++i) {
    const Vec3 a = random_point(1, i, 1), b = random_point(2, i, 1), c = random_point(3, i, 1);
    const Vec3 query = random_point(4, i, 3);
    const double found = (closest_on_triangle(query, a, b, c) - query).norm();
    double sampled = std::numeric_limits<double>::infinity();
    for (int u = 0; u <= 40; ++u) {
      for (int v = 0; u + v <= 40; ++v) {
        const Vec3 point = a + (b - a) * (u / 40.0) + (c - a) * (v / 40.0);
        sampled = std::min(sampled, (point - query).norm());
      }
    }
    EXPECT_LE(found, sampled + 1e-12);
    EXPECT_GE(found, sampled - 0.06);
  }
}

TEST(ClosestOnTriangle, DegenerateTrianglesAreSegmentsAndPoints) {
  const Vec3 a(0, 0, 0), b(1, 0, 0);
  EXPECT_NEAR((closest_on_triangle(Vec3(0.4, 1, 0), a, b, b) - Vec3(0.4, 0, 0)).norm(), 0, 1e-12);
  EXPECT_NEAR((closest_on_triangle(Vec3(0.4, 1, 0), a, a, a) - a).norm(), 0, 1e-12);
}

// Far from the origin, where single precision alone would answer wrongly.
TEST(SpatialIndex, AgreesWithBruteForceAlsoFarFromTheOrigin) {
  for (const double shift : {0.0, 1e5}) {
    Mesh mesh = make_sample_shape(SampleShape::Closed, 600, 3);
    for (Vec3& p : mesh.positions) p += Vec3(shift, -shift, shift);
    const SpatialIndex index(mesh.positions, mesh.triangles);
    for (std::uint64_t i = 0; i < 200; ++i) {
      const Vec3 query = random_point(9, i, 3) + Vec3(shift, -shift, shift);
      double best = std::numeric_limits<double>::infinity();
      std::uint32_t best_triangle = 0;
      for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const Triangle& corners = mesh.triangles[t];
        const double distance =
            (closest_on_triangle(query, mesh.positions[corners[0]], mesh.positions[corners[1]],
                                 mesh.positions[corners[2]]) -
             query)
                .sqrnorm();
        if (distance < best) {
          best = distance;
          best_triangle = t;
        }
      }
      best = std::sqrt(best);
      const ClosestPoint found = index.closest(query, std::numeric_limits<double>::infinity());
      EXPECT_EQ(found.distance, best);
      EXPECT_EQ(found.triangle, best_triangle);
      EXPECT_EQ(index.closest(query, best).distance, best);
      EXPECT_EQ(index.closest(query, best * 0.99).triangle, kNoTriangle);
    }
  }
}

TEST(Hausdorff, OfParallelSheetsIsTheirDistance) {
  const Mesh sheet = test::flat_grid(8, 8);
  Mesh lifted = sheet;
  for (Vec3& p : lifted.positions) p[2] += 0.25;
  EXPECT_NEAR(hausdorff(sheet, lifted, kTolerance).symmetric(), 0.25, 1e-12);
  EXPECT_NEAR(
      hausdorff_of_move(sheet.triangles, sheet.positions, lifted.positions, kTolerance).symmetric(),
      0.25, 1e-12);
}

TEST(Hausdorff, MovingAPointWithinAFlatSheetCostsNothing) {
  const Mesh sheet = test::flat_grid(8, 8);
  Mesh moved = sheet;
  moved.positions[30] += Vec3(0.2, 0.1, 0);
  EXPECT_NEAR(
      hausdorff_of_move(sheet.triangles, sheet.positions, moved.positions, kTolerance).symmetric(),
      0, 1e-14);
  moved.positions[30] += Vec3(0, 0, 0.01);
  EXPECT_NEAR(
      hausdorff_of_move(sheet.triangles, sheet.positions, moved.positions, kTolerance).symmetric(),
      0.01, 1e-12);
}

TEST(Hausdorff, HasTwoDirections) {
  const Mesh large = test::flat_grid(8, 1);
  const Mesh small = test::flat_grid(2, 1);
  const HausdorffDistance distance = hausdorff(large, small, kTolerance);
  EXPECT_NEAR(distance.forward.distance, 6, 1e-12);
  EXPECT_NEAR(distance.backward.distance, 0, 1e-14);
  EXPECT_EQ(distance.symmetric(), distance.forward.distance);
}

TEST(Hausdorff, OfAMoveEqualsThatOfTwoMeshes) {
  const Mesh& before = test::bumpy_ball().mesh;
  Mesh after = before;
  for (std::size_t i = 0; i < after.positions.size(); i += 7) {
    after.positions[i] += random_point(11, i, 0.01);
  }
  const auto general = hausdorff(before, after, kTolerance);
  const auto of_move =
      hausdorff_of_move(before.triangles, before.positions, after.positions, kTolerance);
  EXPECT_NEAR(of_move.forward.distance, general.forward.distance, kTolerance);
  EXPECT_NEAR(of_move.backward.distance, general.backward.distance, kTolerance);
  EXPECT_LE(of_move.symmetric(), displacement(before.positions, after.positions).max);
}

// Only a lower bound could be had from points: a roof's ridge is far from the floor, a valley's
// midline from two walls.
TEST(Hausdorff, FindsTheFarthestPointInsideAFace) {
  const Mesh walls{{Vec3(-1, 0, -1), Vec3(-1, 4, -1), Vec3(-1, 4, 1), Vec3(-1, 0, 1),
                    Vec3(1, 0, -1), Vec3(1, 4, -1), Vec3(1, 4, 1), Vec3(1, 0, 1)},
                   {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}}};
  const Mesh floor{{Vec3(-1, 0, 0), Vec3(1, 0, 0), Vec3(1, 4, 0), Vec3(-1, 4, 0)},
                   {{0, 1, 2}, {0, 2, 3}}};
  const HausdorffDistance distance = hausdorff(floor, walls, kTolerance);
  EXPECT_NEAR(distance.forward.distance, 1, kTolerance);  // along the whole midline
  EXPECT_LE(distance.forward.error, kTolerance);
  EXPECT_NEAR(distance.forward.at[0], 0, 2 * kTolerance);
}

TEST(Hausdorff, OfTwoTessellationsOfAPlaneIsNothing) {
  Mesh coarse = test::flat_grid(7, 5);
  for (Vec3& p : coarse.positions) p = Vec3(p[0] * 3 / 7, p[1] * 3 / 5, 0.1 * p[0]);
  Mesh fine = test::flat_grid(31, 29);
  for (Vec3& p : fine.positions) p = Vec3(p[0] * 3 / 31, p[1] * 3 / 29, 0.1 * p[0] * 7 / 31);
  const HausdorffDistance distance = hausdorff(coarse, fine, kTolerance);
  EXPECT_LE(distance.symmetric(), 1e-14);
  EXPECT_LE(distance.error(), kTolerance);
}

TEST(Hausdorff, SaysHowFarItGotIfItMayNotSplitEnough) {
  const Mesh ball = test::bumpy_ball().mesh;
  const Mesh coarse = test::decimated(ball, 0.9);
  const SpatialIndex index(coarse.positions, coarse.triangles);
  const std::vector<double> reach(ball.triangles.size(), std::numeric_limits<double>::infinity());
  const auto far = farthest_point(ball.positions, ball.triangles, reach, index, {1e-9, 1 << 22});
  const auto hasty = farthest_point(ball.positions, ball.triangles, reach, index, {1e-9, 0});
  EXPECT_LE(far.error, 1e-9);
  EXPECT_GT(hasty.error, 1e-9);
  EXPECT_LE(hasty.distance, far.distance);
  EXPECT_GE(hasty.distance + hasty.error, far.distance);
}

TEST(LeastGreatestMean, IsTheValueOfTheMatrixGame) {
  for (std::uint64_t trial = 0; trial < 200; ++trial) {
    std::array<std::array<double, 3>, 4> columns{};
    for (std::size_t j = 0; j < 4; ++j) {
      const Vec3 entries = random_point(20 + j, trial, 2);
      columns[j] = {entries[0], entries[1], entries[2]};
    }
    double sampled = std::numeric_limits<double>::infinity();
    constexpr int kParts = 100;
    for (int u = 0; u <= kParts; ++u) {
      for (int v = 0; u + v <= kParts; ++v) {
        double greatest = -std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < 3; ++i) {
          greatest = std::max(
              greatest,
              (u * columns[0][i] + v * columns[1][i] + (kParts - u - v) * columns[2][i]) / kParts);
        }
        sampled = std::min(sampled, greatest);
      }
    }
    const double value = least_greatest_mean(std::span(columns).first(3));
    EXPECT_LE(least_greatest_mean(columns), value);
    EXPECT_EQ(least_greatest_mean(std::span(columns).first(1)),
              *std::max_element(columns[0].begin(), columns[0].end()));
    EXPECT_LE(value, sampled + 1e-12);
    EXPECT_GE(value, sampled - 0.05);
  }
}

TEST(Hausdorff, DoesNotDependOnThreads) {
  const Mesh& before = test::bumpy_ball().mesh;
  std::vector<Vec3> after = before.positions;
  for (std::size_t i = 0; i < after.size(); ++i) after[i] += random_point(12, i, 0.01);
  test::expect_same_for_any_threads([&] {
    const auto distance = hausdorff_of_move(before.triangles, before.positions, after, kTolerance);
    return std::array{distance.forward.distance, distance.forward.error, distance.backward.distance,
                      distance.backward.error};
  });
}

TEST(Hausdorff, IsRefusedWithoutFaces) {
  const Mesh points{{Vec3(0, 0, 0)}, {}};
  EXPECT_THROW((void)hausdorff(points, test::flat_grid(1, 1), kTolerance), Error);
  EXPECT_EQ(hausdorff_of_move({}, {}, {}, kTolerance).symmetric(), 0);
}

TEST(BoxDiagonal, IsThatOfTheBox) {
  EXPECT_DOUBLE_EQ(box_diagonal(test::flat_grid(3, 4).positions), 5);
  EXPECT_EQ(box_diagonal({}), 0);
}

TEST(SurfaceDiagonal, LeavesOutPointsThatNoTriangleUses) {
  Mesh mesh = test::flat_grid(3, 4);
  mesh.positions.emplace_back(1000, 0, 0);
  EXPECT_DOUBLE_EQ(surface_diagonal(mesh), 5);
  mesh.triangles.clear();
  EXPECT_EQ(surface_diagonal(mesh), 0);
}

}  // namespace
}  // namespace triglyph
