#include "engine/trace/displaced_points.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "engine/geometry/box.h"
#include "engine/samples/sample_shapes.h"
#include "engine/trace/fingerprint_reading.h"
#include "tests/support/motions.h"

namespace triglyph {
namespace {

constexpr double kFarthest = 0.01;

TEST(DisplacedPoints, MoveAllButFewAndNoFartherThanAsked) {
  const Mesh mesh = make_sample_shape(SampleShape::Closed, 200, 1);
  const FingerprintCode code(Key::trial());
  const std::vector<std::uint32_t> fixed = fixed_points(mesh.positions);
  EXPECT_EQ(fixed.size(), 4U);
  EXPECT_TRUE(std::is_sorted(fixed.begin(), fixed.end()));
  const std::vector<Vec3> moved = displaced(mesh.positions, kFarthest, code, 7);
  std::size_t still = 0;
  for (std::size_t i = 0; i < moved.size(); ++i) {
    const Vec3 move = moved[i] - mesh.positions[i];
    if (move == Vec3(0, 0, 0)) ++still;
    for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_LT(std::abs(move[axis]), kFarthest);
  }
  EXPECT_EQ(still, fixed.size());
  EXPECT_EQ(fixed_points({}).size(), 0U);
  EXPECT_EQ(fixed_points(std::span(mesh.positions).first(3)).size(), 1U);
}

TEST(DisplacedPoints, TellTheNameThroughNoiseOfTheirSize) {
  const Mesh mesh = make_sample_shape(SampleShape::Closed, 400, 1);
  const FingerprintCode code(Key::trial());
  const FingerprintSeed ada = 11, ben = 12;
  double last = 1e9;
  for (const double noise : {0.0, 0.2, 1.0}) {
    const Mesh copy{displaced(mesh.positions, kFarthest, code, ada), mesh.triangles};
    const Mesh shaken = test::shaken(copy, noise * kFarthest, 3);
    const std::vector<std::optional<Vec3>> seen(shaken.positions.begin(), shaken.positions.end());
    const std::vector<ScoreTable> tables = score_points(mesh.positions, seen, kFarthest, 1);
    const double bits = evidence_of(tables, code, ada).bits;
    EXPECT_GT(bits, 40) << noise;
    EXPECT_LE(bits, last);
    EXPECT_LT(evidence_of(tables, code, ben).bits, 10) << noise;
    last = bits;
  }
}

TEST(DisplacedPoints, HaveTheMeanOneOverNames) {
  const Mesh mesh = make_sample_shape(SampleShape::Closed, 100, 1);
  const std::vector<std::optional<Vec3>> seen(mesh.positions.begin(), mesh.positions.end());
  for (const ScoreTable& table : score_points(mesh.positions, seen, kFarthest, 3)) {
    const std::size_t values = std::size_t{1} << table.bits;
    ASSERT_EQ(table.scores.size(), values * table.symbols.size());
    for (std::size_t at = 0; at < table.symbols.size(); ++at) {
      double sum = 0;
      for (std::size_t value = 0; value < values; ++value) {
        sum += std::exp2(double{table.scores[at * values + value]});
      }
      EXPECT_NEAR(sum / static_cast<double>(values), 1, 1e-4);
    }
  }
}

}  // namespace
}  // namespace triglyph
