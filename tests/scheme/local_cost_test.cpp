#include "engine/scheme/local_cost.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/shapes.h"

namespace triglyph {
namespace {

// A flat grid of unit squares; point 12 is its middle.
class FlatGrid : public testing::Test {
 protected:
  test::Solid grid_{test::flat_grid(4, 4)};
  const Vec3 middle_ = grid_.mesh.positions[12];

  [[nodiscard]] float cost(CostFunction function, const Vec3& by) const {
    const std::array<Move, 1> moves{{{12, middle_ + by}}};
    return LocalCost(grid_.surface(), function).of_part(moves);
  }
};

TEST_F(FlatGrid, SlidingCostsDistanceButLittleShapeAndNoShading) {
  const Vec3 slide(0.2, 0.1, 0);
  EXPECT_FLOAT_EQ(cost(CostFunction::Displacement, slide), std::sqrt(0.05F));
  EXPECT_FLOAT_EQ(cost(CostFunction::Rms, slide), 0.05F);  // squares, until they are combined
  EXPECT_NEAR(cost(CostFunction::Hausdorff, slide), 0.1 * std::sqrt(0.05), 1e-7);
  EXPECT_NEAR(cost(CostFunction::Normal, slide), 0, 1e-7);
}

TEST_F(FlatGrid, RisingCostsItsHeightAndTheTiltOfTheFaces) {
  const Vec3 rise(0, 0, 0.1);
  EXPECT_FLOAT_EQ(cost(CostFunction::Hausdorff, rise), 0.1F);
  // a face whose far edge lies at distance d turns by atan(h / d); |n - n'| = 2 sin(angle / 2)
  const double d = std::sqrt(0.5);
  const double steep = 2 * std::sin(std::atan(0.1 / d) / 2) * std::sqrt(0.5);
  EXPECT_LE(cost(CostFunction::Normal, rise), steep + 1e-6);
  EXPECT_GE(cost(CostFunction::Normal, rise), 2 * std::sin(std::atan(0.1) / 2) * std::sqrt(0.5));
  EXPECT_GT(cost(CostFunction::Normal, rise * 2), 1.8F * cost(CostFunction::Normal, rise));
}

TEST_F(FlatGrid, TurningAFaceOverIsTheDearestChange) {
  const float over = cost(CostFunction::Normal, Vec3(2.5, 0, 0));
  EXPECT_FLOAT_EQ(over, 2 * std::sqrt(0.5F));
}

TEST(LocalCostFunctions, CombineByTheirRule) {
  const test::Solid grid(test::flat_grid(2, 2));
  const std::array<float, 3> parts{1, 4, 4};
  EXPECT_FLOAT_EQ(LocalCost(grid.surface(), CostFunction::Normal).combine(parts, 9), 4);
  EXPECT_FLOAT_EQ(LocalCost(grid.surface(), CostFunction::Displacement).combine(parts, 9), 4);
  EXPECT_FLOAT_EQ(LocalCost(grid.surface(), CostFunction::Rms).combine(parts, 9), 1);
}

TEST(LocalCostFunctions, AreNamed) {
  std::size_t index = 0;
  for (const std::string_view name : cost_names()) {
    EXPECT_EQ(name_of(static_cast<CostFunction>(index++)), name);
  }
  EXPECT_EQ(cost_names().size(), 4U);
}

}  // namespace
}  // namespace triglyph
