#include "engine/mesh/fewer_triangles.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/support/motions.h"

namespace triglyph {
namespace {

TEST(FewerTriangles, AreBetweenPointsOfTheMeshAndAboutAsManyAsAsked) {
  const Mesh mesh = test::sphere(60, 1);
  for (const auto simplify : {collapsed, clustered}) {
    EXPECT_EQ(simplify(mesh, mesh.triangles.size()), mesh.triangles);
    for (const std::size_t kept : {3000U, 500U}) {
      const std::vector<Triangle> left = simplify(mesh, kept);
      EXPECT_LE(left.size(), kept);
      EXPECT_GE(left.size(), kept / 2);
      for (const Triangle& t : left) {
        EXPECT_LT(*std::max_element(t.begin(), t.end()), mesh.positions.size());
      }
    }
  }
}

// A plane is flat everywhere: its errors say nothing of where to keep points.
TEST(FewerTriangles, OfClustersLieEverywhereAlike) {
  Mesh plane;
  constexpr std::uint32_t kSide = 64;
  for (std::uint32_t i = 0; i <= kSide; ++i) {
    for (std::uint32_t j = 0; j <= kSide; ++j) plane.positions.emplace_back(i, j, 0);
  }
  for (std::uint32_t i = 0; i < kSide; ++i) {
    for (std::uint32_t j = 0; j < kSide; ++j) {
      const std::uint32_t a = i * (kSide + 1) + j;
      plane.triangles.push_back({a, a + kSide + 1, a + 1});
      plane.triangles.push_back({a + 1, a + kSide + 1, a + kSide + 2});
    }
  }
  double longest = 0;
  const std::vector<Triangle> left = clustered(plane, 800);
  for (const Triangle& t : left) {
    for (std::size_t c = 0; c < 3; ++c) {
      longest = std::max(longest, (plane.positions[t[c]] - plane.positions[t[(c + 1) % 3]]).norm());
    }
  }
  EXPECT_GT(left.size(), 200U);
  EXPECT_LT(longest, 4 * kSide / std::sqrt(static_cast<double>(left.size()) / 2));
}

}  // namespace
}  // namespace triglyph
