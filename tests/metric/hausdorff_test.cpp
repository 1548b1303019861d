#include "engine/metric/hausdorff.h"

#include <limits>

#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "engine/base/random.h"
#include "engine/mesh/spatial_index.h"
#include "tests/support/arenas.h"
#include "tests/support/shapes.h"

namespace triglyph {
namespace {

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
  EXPECT_NEAR(hausdorff(sheet, lifted).symmetric(), 0.25, 1e-12);
  EXPECT_NEAR(hausdorff_of_move(sheet.triangles, sheet.positions, lifted.positions).symmetric(),
              0.25, 1e-12);
}

TEST(Hausdorff, MovingAPointWithinAFlatSheetCostsNothing) {
  const Mesh sheet = test::flat_grid(8, 8);
  Mesh moved = sheet;
  moved.positions[30] += Vec3(0.2, 0.1, 0);
  EXPECT_NEAR(hausdorff_of_move(sheet.triangles, sheet.positions, moved.positions).symmetric(), 0,
              1e-14);
  moved.positions[30] += Vec3(0, 0, 0.01);
  EXPECT_NEAR(hausdorff_of_move(sheet.triangles, sheet.positions, moved.positions).symmetric(),
              0.01, 1e-12);
}

TEST(Hausdorff, HasTwoDirections) {
  const Mesh large = test::flat_grid(8, 1);
  const Mesh small = test::flat_grid(2, 1);
  const HausdorffDistance distance = hausdorff(large, small);
  EXPECT_NEAR(distance.forward, 6, 1e-12);
  EXPECT_NEAR(distance.backward, 0, 1e-14);
  EXPECT_EQ(distance.symmetric(), distance.forward);
}

TEST(Hausdorff, OfAMoveEqualsThatOfTwoMeshes) {
  const Mesh& before = test::bumpy_ball().mesh;
  Mesh after = before;
  for (std::size_t i = 0; i < after.positions.size(); i += 7) {
    after.positions[i] += random_point(11, i, 0.01);
  }
  const auto general = hausdorff(before, after);
  const auto of_move = hausdorff_of_move(before.triangles, before.positions, after.positions);
  EXPECT_EQ(of_move.forward, general.forward);
  EXPECT_EQ(of_move.backward, general.backward);
  EXPECT_LE(of_move.symmetric(), displacement(before.positions, after.positions).max);
}

TEST(Hausdorff, DoesNotDependOnThreads) {
  const Mesh& before = test::bumpy_ball().mesh;
  std::vector<Vec3> after = before.positions;
  for (std::size_t i = 0; i < after.size(); ++i) after[i] += random_point(12, i, 0.01);
  test::expect_same_for_any_threads([&] {
    const auto distance = hausdorff_of_move(before.triangles, before.positions, after);
    return std::make_pair(distance.forward, distance.backward);
  });
}

TEST(Hausdorff, IsRefusedWithoutFaces) {
  const Mesh points{{Vec3(0, 0, 0)}, {}};
  EXPECT_THROW((void)hausdorff(points, test::flat_grid(1, 1)), Error);
  EXPECT_EQ(hausdorff_of_move({}, {}, {}).symmetric(), 0);
}

TEST(Displacement, IsMaximumAndRootMeanSquare) {
  const std::vector<Vec3> before(4, Vec3(1, 1, 1));
  std::vector<Vec3> after = before;
  after[2] += Vec3(3, 4, 0);
  const Displacement moved = displacement(before, after);
  EXPECT_DOUBLE_EQ(moved.max, 5);
  EXPECT_DOUBLE_EQ(moved.rms, 2.5);
  EXPECT_THROW((void)displacement(before, {}), std::logic_error);
}

TEST(BoxDiagonal, IsThatOfTheBox) {
  EXPECT_DOUBLE_EQ(box_diagonal(test::flat_grid(3, 4).positions), 5);
  EXPECT_EQ(box_diagonal({}), 0);
}

}  // namespace
}  // namespace triglyph
