#include "engine/scheme/tsq/triangle_shape.h"

#include <gtest/gtest.h>

#include "engine/base/random.h"

namespace triglyph {
namespace {

TEST(TriangleShape, ApexComesBackFromItsShape) {
  for (std::uint64_t i = 0; i < 5000; ++i) {
    const double x = 4 * random_unit(2, 0, i) - 1.5;
    const double height = 0.02 + 2 * random_unit(2, 1, i);
    const TriangleShape shape = FlatTriangle{1, x, height}.shape();
    const auto found = apex_x(shape.height, std::tanh(shape.log_ratio), x);
    ASSERT_TRUE(found);
    EXPECT_NEAR(*found, x, 1e-6);
  }
}

TEST(TriangleShape, NoApexBeyondTheCircle) {
  // height / base <= ratio / |1 - ratio^2| = 1 / (2 sinh |log ratio|)
  for (std::uint64_t i = 0; i < 1000; ++i) {
    const double log_ratio = 0.05 + 2 * random_unit(3, 0, i);
    const double limit = 1 / (2 * std::sinh(log_ratio));
    EXPECT_TRUE(apex_x(limit * (1 - 1e-9), std::tanh(log_ratio), 0.5));
    EXPECT_FALSE(apex_x(limit * (1 + 1e-9), std::tanh(log_ratio), 0.5));
  }
}

TEST(TriangleShape, FlattenKeepsShapeUnderSimilarity) {
  const Vec3 a(1, 2, 3), b(4, 0, 2), c(2, 5, -1);
  const FlatTriangle flat = flatten(a, b, c);
  const auto turned = [](const Vec3& p) {
    return Vec3(-p[1], p[0], p[2]) * 7.0 + Vec3(10, -20, 30);
  };
  const FlatTriangle other = flatten(turned(a), turned(b), turned(c));
  EXPECT_NEAR(other.shape().height, flat.shape().height, 1e-12);
  EXPECT_NEAR(other.shape().log_ratio, flat.shape().log_ratio, 1e-12);
  EXPECT_NEAR(other.base, 7 * flat.base, 1e-9);
}

TEST(TriangleShape, SwappingTheBaseNegatesTheRatio) {
  const Vec3 a(0, 0, 0), b(1, 0, 0), c(0.3, 0.7, 0);
  const TriangleShape shape = flatten(a, b, c).shape();
  const TriangleShape swapped = flatten(b, a, c).shape();
  EXPECT_NEAR(shape.height, swapped.height, 1e-15);
  EXPECT_NEAR(shape.log_ratio, -swapped.log_ratio, 1e-15);
}

double sum_of_squares(const FlatTriangle& triangle, const FlatCorners& corners, double scale,
                      double turn, double shift_x, double shift_y) {
  const std::array<double, 3> x{0, triangle.base, triangle.base * triangle.x};
  const std::array<double, 3> y{0, 0, triangle.base * triangle.height};
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double px = scale * (std::cos(turn) * corners.x[i] - std::sin(turn) * corners.y[i]);
    const double py = scale * (std::sin(turn) * corners.x[i] + std::cos(turn) * corners.y[i]);
    sum += std::pow(px + shift_x - x[i], 2) + std::pow(py + shift_y - y[i], 2);
  }
  return sum;
}

TEST(Reshape, TakesTheShapeAndNoSimilarityMovesLess) {
  for (std::uint64_t i = 0; i < 200; ++i) {
    const FlatTriangle triangle{0.5 + random_unit(4, 0, i), random_unit(4, 1, i),
                                0.1 + random_unit(4, 2, i)};
    const double x = triangle.x + 0.2 * random_unit(4, 3, i);
    const double height = triangle.height + 0.2 * random_unit(4, 4, i);
    const FlatCorners moved = reshape(triangle, x, height);
    const FlatTriangle result =
        flatten(Vec3(moved.x[0], moved.y[0], 0), Vec3(moved.x[1], moved.y[1], 0),
                Vec3(moved.x[2], moved.y[2], 0));
    EXPECT_NEAR(result.x, x, 1e-9);
    EXPECT_NEAR(result.height, height, 1e-9);
    const double best = sum_of_squares(triangle, moved, 1, 0, 0, 0);
    for (const double d : {-1e-3, 1e-3}) {
      EXPECT_GE(sum_of_squares(triangle, moved, 1 + d, 0, 0, 0), best);
      EXPECT_GE(sum_of_squares(triangle, moved, 1, d, 0, 0), best);
      EXPECT_GE(sum_of_squares(triangle, moved, 1, 0, d, 0), best);
      EXPECT_GE(sum_of_squares(triangle, moved, 1, 0, 0, d), best);
    }
  }
}

}  // namespace
}  // namespace triglyph
