#include "engine/metric/sampled_distance.h"

#include <cmath>

#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "engine/metric/hausdorff.h"
#include "tests/support/arenas.h"
#include "tests/support/motions.h"
#include "tests/support/remeshing.h"
#include "tests/support/shapes.h"

namespace triglyph {
namespace {

constexpr double kExactTolerance = 1e-7;

Mesh lifted_sheet(double height) {
  Mesh sheet = test::flat_grid(6, 6);
  for (Vec3& p : sheet.positions) p[2] += height;
  return sheet;
}

TEST(Metro, OfParallelSheetsIsTheirDistance) {
  const TwoWayStatistics s = metro(lifted_sheet(0), lifted_sheet(0.25));
  for (const DistanceStatistics& way : {s.forward, s.backward}) {
    EXPECT_NEAR(way.max, 0.25, 1e-12);
    EXPECT_NEAR(way.mean, 0.25, 1e-12);
    EXPECT_NEAR(way.rms, 0.25, 1e-12);
  }
}

// 10 samples a face: 49 points, then edges at sqrt(left / area) a length, then faces with what is
// left after the points have counted twice.
TEST(Metro, SpendsItsBudgetInOrder) {
  const Mesh sheet = lifted_sheet(0);
  const double target = 10.0 * 72;
  const TwoWayStatistics s = metro(sheet, lifted_sheet(1));
  const double length = 2 * 7 * 6 + 36 * std::sqrt(2.0);
  const double on_edges = std::floor(length * std::sqrt((target - 49) / 36));
  const double for_faces = target - 2 * 49 - on_edges;
  EXPECT_NEAR(static_cast<double>(s.forward.samples), 49 + on_edges + for_faces, for_faces);
  EXPECT_GE(static_cast<double>(s.forward.samples), 49 + on_edges);
}

TEST(Metro, OfATiltedSheetIsThatOfALinearFunction) {
  const Mesh flat = test::flat_grid(40, 40);
  Mesh tilted = flat;
  for (Vec3& p : tilted.positions) p[2] = 0.001 * p[0];
  const TwoWayStatistics s = metro(tilted, flat);
  EXPECT_NEAR(s.forward.max, 0.04, 1e-9);
  EXPECT_NEAR(s.forward.mean, 0.02, 2e-4);
  EXPECT_NEAR(s.forward.rms, 0.04 / std::sqrt(3.0), 2e-4);
}

TEST(MeshDistance, IntegratesALinearFunctionExactly) {
  const Mesh flat{{Vec3(-9, -9, 0), Vec3(9, -9, 0), Vec3(9, 9, 0), Vec3(-9, 9, 0)},
                  {{0, 1, 2}, {0, 2, 3}}};
  const Mesh tilted{{Vec3(0, 0, 0), Vec3(3, 0, 0.6), Vec3(3, 3, 0.6), Vec3(0, 3, 0)},
                    {{0, 1, 2}, {0, 2, 3}}};
  const TwoWayStatistics s = mesh_distance(tilted, flat, 0.37);
  EXPECT_NEAR(s.forward.max, 0.6, 1e-12);
  EXPECT_NEAR(s.forward.mean, 0.3, 1e-12);
  EXPECT_NEAR(s.forward.rms, 0.6 / std::sqrt(3.0), 1e-12);
}

TEST(SampledDistances, AreBelowTheCertifiedOneAndNearIt) {
  const Mesh& ball = test::bumpy_ball().mesh;
  const Mesh coarse = test::decimated(ball, 0.7);
  const double exact = hausdorff(ball, coarse, kExactTolerance).symmetric();
  const TwoWayStatistics by_metro = metro(ball, coarse);
  const TwoWayStatistics by_mesh = mesh_distance(ball, coarse, 0.01);
  for (const TwoWayStatistics& s : {by_metro, by_mesh}) {
    const double sampled = std::max(s.forward.max, s.backward.max);
    EXPECT_LE(sampled, exact + kExactTolerance);
    EXPECT_GE(sampled, 0.9 * exact);
    EXPECT_LE(s.forward.mean, s.forward.rms);
    EXPECT_LE(s.forward.rms, s.forward.max);
  }
  EXPECT_NEAR(by_metro.forward.rms, by_mesh.forward.rms, 0.1 * by_mesh.forward.rms);
}

TEST(SampledDistances, DoNotDependOnThreads) {
  const Mesh& ball = test::bumpy_ball().mesh;
  const Mesh other = test::shaken(ball, 0.01, 1);
  test::expect_same_for_any_threads([&] {
    const TwoWayStatistics a = metro(ball, other);
    const TwoWayStatistics b = mesh_distance(ball, other, 0.02);
    return std::array{a.forward.mean, a.backward.rms, b.forward.mean, b.backward.rms};
  });
}

// Each sample would look at every face; broken exporters write such meshes.
TEST(SampledDistances, PassOverFacesThatLieOnOneAnother) {
  Mesh pile{{Vec3(0.1, 0.2, 0.3), Vec3(1.3, 0.1, 0.2), Vec3(0.2, 1.1, 0.7)}, {}};
  pile.triangles.assign(3000, {0, 1, 2});
  const TwoWayStatistics s = mesh_distance(pile, pile, 0.02);
  EXPECT_LT(s.forward.max, 1e-14);
  EXPECT_GT(s.forward.samples, 3'000'000U);
}

// Two faces of area 1/2 and one a billion long: samples go by the budget, not by the length.
Mesh with_needle(double length, double width) {
  return {{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(length, 0, 0),
           Vec3(length, width, 0)},
          {{0, 2, 1}, {0, 1, 3}, {0, 4, 5}}};
}

TEST(SampledDistances, OfNeedlesTakeNoMoreSamplesThanTheirBudget) {
  const Mesh mesh = with_needle(1e9, 1e-9);
  const TwoWayStatistics s = metro(mesh, mesh);
  EXPECT_LE(s.forward.samples, 3U * 10 * 3);
  const Mesh fan = with_needle(100, 0.5);
  const TwoWayStatistics by_step = mesh_distance(fan, fan, 0.1);
  EXPECT_LE(by_step.forward.samples, 10000U);  // half a million as similar triangles
}

TEST(MeshDistance, IntegratesALinearFunctionOverNeedlesExactly) {
  const Mesh flat{{Vec3(-99, -99, 0), Vec3(99, -99, 0), Vec3(99, 99, 0), Vec3(-99, 99, 0)},
                  {{0, 1, 2}, {0, 2, 3}}};
  // The distance grows from 0 to 0.8 along a needle; its mean is that of the corners.
  const Mesh needle{{Vec3(0, 0, 0), Vec3(8, 0, 0.8), Vec3(2, 0.4, 0.2)}, {{0, 1, 2}}};
  const double area = triangle_area(needle.positions, needle.triangles[0]);
  EXPECT_LT(area, 2);
  const TwoWayStatistics s = mesh_distance(needle, flat, 0.15);
  EXPECT_NEAR(s.forward.mean, 1.0 / 3, kExactTolerance);
  EXPECT_NEAR(s.forward.rms, std::sqrt((0.64 + 0.04 + 1.0) / 12), kExactTolerance);
  EXPECT_NEAR(s.forward.max, 0.8, kExactTolerance);
}

TEST(SampledDistances, AreRefusedWithoutFaces) {
  const Mesh points{{Vec3(0, 0, 0)}, {}};
  EXPECT_THROW((void)metro(points, test::flat_grid(1, 1)), Error);
  EXPECT_THROW((void)mesh_distance(test::flat_grid(1, 1), points, 0.1), Error);
}

}  // namespace
}  // namespace triglyph
