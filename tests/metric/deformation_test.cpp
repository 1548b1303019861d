#include "engine/metric/deformation.h"

#include <limits>

#include <gtest/gtest.h>

#include "tests/support/motions.h"
#include "tests/support/shapes.h"

namespace triglyph {
namespace {

TEST(Displacement, IsMaximumMeanAndRootMeanSquare) {
  const std::vector<Vec3> before(4, Vec3(1, 1, 1));
  std::vector<Vec3> after = before;
  after[2] += Vec3(3, 4, 0);
  const Displacement moved = displacement(before, after);
  EXPECT_DOUBLE_EQ(moved.max, 5);
  EXPECT_DOUBLE_EQ(moved.mean, 1.25);
  EXPECT_DOUBLE_EQ(moved.rms, 2.5);
  EXPECT_THROW((void)displacement(before, {}), std::logic_error);
}

TEST(SignalToNoise, IsInDecibelAboutTheCentroid) {
  const std::vector<Vec3> before = {Vec3(9, 0, 0), Vec3(11, 0, 0)};
  const std::vector<Vec3> after = {Vec3(9, 0.1, 0), Vec3(11, 0, 0.1)};
  EXPECT_NEAR(signal_to_noise(before, after), 20, 1e-9);  // 2 over 0.02
  EXPECT_EQ(signal_to_noise(before, before), std::numeric_limits<double>::infinity());
}

TEST(Strain, IsThatOfAStretchedMembrane) {
  const Mesh sheet = test::flat_grid(4, 3);
  std::vector<Vec3> stretched = sheet.positions;
  for (Vec3& p : stretched) p[0] *= 1.1;
  EXPECT_NEAR(strain(sheet.triangles, sheet.positions, stretched), 0.1 / std::sqrt(2.0), 1e-12);
  for (Vec3& p : stretched) p[1] *= 0.7;
  EXPECT_NEAR(strain(sheet.triangles, sheet.positions, stretched), std::sqrt((0.01 + 0.09) / 2),
              1e-12);
  std::vector<Vec3> sheared = sheet.positions;  // s = 1 / t, s - t = 0.2
  for (Vec3& p : sheared) p[0] += 0.2 * p[1];
  const double s = 0.1 + std::sqrt(1.01);
  EXPECT_NEAR(strain(sheet.triangles, sheet.positions, sheared),
              std::sqrt(((s - 1) * (s - 1) + (1 / s - 1) * (1 / s - 1)) / 2), 1e-9);
}

TEST(Strain, IsBlindToRigidMotionAndBending) {
  const Mesh& ball = test::bumpy_ball().mesh;
  EXPECT_NEAR(strain(ball.triangles, ball.positions, test::moved_rigidly(ball).positions), 0, 1e-7);
  const Mesh sheet = test::flat_grid(4, 1);
  std::vector<Vec3> folded = sheet.positions;  // along the line x = 2
  for (Vec3& p : folded) {
    if (p[0] > 2) p = Vec3(2, p[1], p[0] - 2);
  }
  EXPECT_NEAR(strain(sheet.triangles, sheet.positions, folded), 0, 1e-12);
}

TEST(NormalDeviation, IsTheAngleAFaceTurnsBy) {
  const Mesh sheet = test::flat_grid(4, 1);
  std::vector<Vec3> folded = sheet.positions;
  for (Vec3& p : folded) {
    if (p[0] > 3) p = Vec3(3, p[1], p[0] - 3);
  }
  const NormalDeviation angles = normal_deviation(sheet.triangles, sheet.positions, folded);
  EXPECT_NEAR(angles.max, 90, 1e-9);
  EXPECT_NEAR(angles.mean, 90.0 / 4, 1e-9);
  const std::vector<Vec3> point(sheet.positions.size(), Vec3(0, 0, 0));
  EXPECT_EQ(normal_deviation(sheet.triangles, sheet.positions, point).max, 0);
}

}  // namespace
}  // namespace triglyph
