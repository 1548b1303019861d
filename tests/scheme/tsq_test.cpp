#include "engine/scheme/tsq/tsq.h"

#include <set>

#include <gtest/gtest.h>

#include "tests/support/shapes.h"

namespace triglyph {
namespace {

TEST(Tsq, UnitsAreSixDistinctPointsInOrder) {
  const TsqScheme scheme(WordCode(Key::trial(), {6, 8, 9}), {});
  const auto& ball = test::bumpy_ball();
  const UnitSet units = scheme.bind(ball.surface())->find_units();
  EXPECT_GT(units.size(), ball.mesh.triangles.size() * 9 / 10);
  EXPECT_TRUE(std::is_sorted(units.anchors.begin(), units.anchors.end()));
  for (std::size_t i = 0; i < units.size(); ++i) {
    const auto points = units.moved[i];
    EXPECT_EQ(std::set<std::uint32_t>(points.begin(), points.end()).size(), 6U);
  }
}

}  // namespace
}  // namespace triglyph
