#include "engine/mesh/triangulate.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "engine/base/random.h"

namespace triglyph {
namespace {

std::vector<Triangle> cut(const std::vector<std::uint32_t>& polygon,
                          const std::vector<Vec3>& points) {
  Faces faces;
  faces.corners = polygon;
  faces.ends = {static_cast<std::uint32_t>(polygon.size())};
  std::vector<std::uint32_t> identity(points.size());
  std::iota(identity.begin(), identity.end(), 0U);
  return triangulate(faces, identity, points);
}

// Triangles as cycles that start at their smallest point.
std::set<Triangle> cycles(std::vector<Triangle> triangles) {
  for (Triangle& t : triangles)
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  return {triangles.begin(), triangles.end()};
}

std::vector<Vec3> random_points(std::uint64_t seed, std::size_t n) {
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < n; ++i) {
    points.emplace_back(random_unit(seed, 0, i), random_unit(seed, 1, i), random_unit(seed, 2, i));
  }
  return points;
}

TEST(Triangulate, CutsQuadranglesAlongTheShorterDiagonal) {
  const std::vector<Vec3> points = {{-2, 0, 0}, {0, -1, 0}, {2, 0, 0}, {0, 1, 0}};
  EXPECT_EQ(cycles(cut({0, 1, 2, 3}, points)), (std::set<Triangle>{{0, 1, 3}, {1, 2, 3}}));
}

TEST(Triangulate, CutsSquaresAtTheSmallestPosition) {
  const std::vector<Vec3> points = {{1, 1, 0}, {0, 1, 0}, {0, 0, 0}, {1, 0, 0}};
  EXPECT_EQ(cycles(cut({0, 1, 2, 3}, points)), (std::set<Triangle>{{0, 1, 2}, {0, 2, 3}}));
}

TEST(Triangulate, FansFromTheLeastSumOfSquaredDistances) {
  const auto points = random_points(3, 9);
  const auto triangles = cut({0, 1, 2, 3, 4, 5, 6, 7, 8}, points);
  ASSERT_EQ(triangles.size(), 7U);
  std::vector<double> sums(9, 0.0);
  for (std::size_t i = 0; i < 9; ++i) {
    for (const Vec3& q : points) sums[i] += (points[i] - q).sqrnorm();
  }
  const auto best =
      static_cast<std::uint32_t>(std::min_element(sums.begin(), sums.end()) - sums.begin());
  for (const Triangle& t : triangles) EXPECT_NE(std::find(t.begin(), t.end(), best), t.end());
}

TEST(Triangulate, DoesNotDependOnTheFirstCorner) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    const std::size_t n = 3 + seed % 9;
    auto points = random_points(seed, n);
    if (seed % 2 == 0) {
      for (std::size_t i = 0; i < n; ++i) {  // regular polygons are all ties
        const double angle =
            2 * 3.141592653589793 * static_cast<double>(i) / static_cast<double>(n);
        points[i] = {std::cos(angle), std::sin(angle), 0};
      }
    }
    std::vector<std::uint32_t> polygon(n);
    std::iota(polygon.begin(), polygon.end(), 0U);
    if (seed % 5 == 0) polygon.push_back(polygon[seed % n]);  // a point that comes twice
    const auto expected = cycles(cut(polygon, points));
    for (std::size_t turn = 1; turn < polygon.size(); ++turn) {
      std::rotate(polygon.begin(), polygon.begin() + 1, polygon.end());
      EXPECT_EQ(cycles(cut(polygon, points)), expected) << seed;
    }
  }
}

TEST(Triangulate, IsInvariantUnderSimilarity) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const std::size_t n = 4 + seed % 6;
    const auto points = random_points(seed, n);
    std::vector<Vec3> turned;
    const double c = std::cos(1.0 + static_cast<double>(seed)),
                 s = std::sin(1.0 + static_cast<double>(seed));
    for (const Vec3& p : points) {
      turned.emplace_back(7 * (c * p[0] - s * p[1]) + 3, 7 * (s * p[0] + c * p[1]) - 5,
                          7 * p[2] + 11);
    }
    std::vector<std::uint32_t> polygon(n);
    std::iota(polygon.begin(), polygon.end(), 0U);
    EXPECT_EQ(cycles(cut(polygon, points)), cycles(cut(polygon, turned))) << seed;
  }
}

TEST(Triangulate, LeavesOutTrianglesThatRepeatAPoint) {
  const auto points = random_points(1, 5);
  EXPECT_TRUE(cut({0, 1, 1}, points).empty());
  EXPECT_TRUE(cut({0, 1}, points).empty());
  EXPECT_TRUE(cut({}, points).empty());
  EXPECT_EQ(cut({0, 1, 2, 2}, points).size(), 1U);
  EXPECT_TRUE(cut(std::vector<std::uint32_t>(20000, 3), points).empty());
}

}  // namespace
}  // namespace triglyph
