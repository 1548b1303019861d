#include "engine/scheme/aie/affine_norm.h"

#include <cmath>

#include <gtest/gtest.h>

#include "engine/base/random.h"

namespace triglyph {
namespace {

constexpr double kPlaneBelow = 1e-6;

Vec3 random_point(std::uint64_t seed, std::uint64_t index) {
  return Vec3(random_unit(seed, index, 0), random_unit(seed, index, 1),
              random_unit(seed, index, 2));
}

std::array<Vec3, 4> random_basis(std::uint64_t seed, double thickness) {
  std::array<Vec3, 4> basis;
  for (std::size_t i = 0; i < 4; ++i) {
    basis[i] = random_point(seed, i);
    basis[i][2] *= thickness;
  }
  return basis;
}

struct AffineMap {
  std::array<Vec3, 3> rows;
  Vec3 shift;
  explicit AffineMap(std::uint64_t seed)
      : rows{random_point(seed, 0) - Vec3(0.5, 0.5, 0.5), random_point(seed, 1) * 2,
             random_point(seed, 2) - Vec3(1, 0, 0.5)},
        shift(random_point(seed, 3) * 10) {}
  [[nodiscard]] Vec3 operator()(const Vec3& p) const {
    return Vec3(dot(rows[0], p), dot(rows[1], p), dot(rows[2], p)) + shift;
  }
};

// Barycentric coordinates of a point in the tetrahedron of the basis.
std::array<double, 4> barycentric(const std::array<Vec3, 4>& v, const Vec3& p) {
  const auto volume = [](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    return dot(b - a, cross(c - a, d - a));
  };
  const double all = volume(v[0], v[1], v[2], v[3]);
  return {volume(p, v[1], v[2], v[3]) / all, volume(v[0], p, v[2], v[3]) / all,
          volume(v[0], v[1], p, v[3]) / all, volume(v[0], v[1], v[2], p) / all};
}

TEST(AffineNorm, IsTheBarycentricFormula) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const auto basis = random_basis(seed, 0.3);
    const AffineNorm norm(basis, kPlaneBelow);
    const Vec3 point = random_point(seed, 9) * 3;
    double sum = 0;
    for (const double lambda : barycentric(basis, point)) sum += lambda * lambda;
    EXPECT_NEAR(norm(point), std::sqrt(4 * sum - 1), 1e-6 * norm(point));
    for (const Vec3& corner : basis) EXPECT_NEAR(norm(corner), std::sqrt(3.0), 1e-6);
  }
}

TEST(AffineNorm, IsTheSameAfterAnyAffineMap) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const auto basis = random_basis(seed, 0.1);
    const Vec3 point = random_point(seed, 9) * 3;
    const AffineMap map(seed);
    const AffineNorm before(basis, kPlaneBelow);
    const AffineNorm after({map(basis[0]), map(basis[1]), map(basis[2]), map(basis[3])},
                           kPlaneBelow);
    EXPECT_NEAR(after(map(point)), before(point), 1e-5 * before(point));
  }
}

TEST(AffineNorm, OfAPlaneIsTheSameAfterAnyAffineMap) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const auto basis = random_basis(seed, 0);
    Vec3 point = random_point(seed, 9) * 3;
    point[2] = 0;
    const AffineMap map(seed);
    const AffineNorm before(basis, kPlaneBelow);
    const AffineNorm after({map(basis[0]), map(basis[1]), map(basis[2]), map(basis[3])},
                           kPlaneBelow);
    EXPECT_TRUE(before.is_plane() && after.is_plane());
    EXPECT_LT(before.flatness(), 1e-7);
    EXPECT_NEAR(after(map(point)), before(point), 1e-5 * before(point));
    EXPECT_LT(after.height(map(point)), 1e-7);
    const Vec3 target = before.nearest_with_norm(point, 2.5);
    EXPECT_NEAR(target[2], 0, 1e-9);
    EXPECT_NEAR(before(target), 2.5, 1e-9);
  }
}

// The nearest point is found by another way: many points of the level set.
TEST(AffineNorm, NearestPointHasTheNormAndNoOtherIsNearer) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const AffineNorm norm(random_basis(seed, seed % 2 == 0 ? 0.3 : 0.02), kPlaneBelow);
    const Vec3 point = random_point(seed, 9) * 2;
    const double wanted = norm(point) * (0.2 + 2 * random_unit(seed, 9, 9));
    const Vec3 target = norm.nearest_with_norm(point, wanted);
    EXPECT_NEAR(norm(target), wanted, 1e-9 * wanted);
    const double move = (target - point).norm();
    const AffineNorm& level = norm;
    const Vec3& centre = norm.mean();
    for (std::uint64_t k = 0; k < 2000; ++k) {
      Vec3 other = centre + random_point(seed, 100 + k) - Vec3(0.5, 0.5, 0.5);
      if (k % 2 == 1) other = target + (other - centre) * 0.05;  // beside the answer
      other = centre + (other - centre) * (wanted / level(other));
      EXPECT_GE((other - point).norm(), move * (1 - 1e-9));
    }
  }
}

// The bound holds in space and in a plane, and along the axis of least deviation it is the
// distance.
TEST(AffineNorm, LeastDistanceIsABoundAndIsReached) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const bool is_plane = seed % 4 == 0;
    const AffineNorm norm(random_basis(seed, is_plane ? 0 : 0.3), kPlaneBelow);
    ASSERT_EQ(norm.is_plane(), is_plane);
    Vec3 point = random_point(seed, 9) * 2;
    if (is_plane) point[2] = 0;
    const double wanted = norm(point) * (0.2 + 2 * random_unit(seed, 9, 9));
    const double bound = norm.least_distance(norm(point), wanted);
    EXPECT_LE(bound, (norm.nearest_with_norm(point, wanted) - point).norm() * (1 + 1e-9));
    EXPECT_EQ(bound, norm.least_distance(wanted, norm(point)));
  }
  const AffineNorm norm({Vec3(1, 0, 0.1), Vec3(-1, 0, 0.1), Vec3(0, 1, -0.1), Vec3(0, -1, -0.1)},
                        kPlaneBelow);
  const Vec3 low(0, 0, 0.2), high(0, 0, 0.5);
  EXPECT_NEAR(norm.least_distance(norm(low), norm(high)), 0.3, 1e-12);
}

TEST(AffineNorm, PointsInThePlaneOfSymmetryLeaveIt) {
  // y on the plane of the two greater axes, wanted norm out of its reach there
  const std::array<Vec3, 4> basis{Vec3(1, 0, 0.01), Vec3(-1, 0, 0.01), Vec3(0, 1, -0.01),
                                  Vec3(0, -1, -0.01)};
  const AffineNorm norm(basis, kPlaneBelow);
  const Vec3 point(0.3, 0.2, 0);
  const double wanted = 4;
  const Vec3 target = norm.nearest_with_norm(point, wanted);
  EXPECT_NEAR(norm(target), wanted, 1e-9);
  EXPECT_LT((target - point).norm(), 0.05);
}

TEST(AffineNorm, OfALineSaysSo) {
  const AffineNorm norm({Vec3(0, 0, 0), Vec3(1, 1, 1), Vec3(2, 2, 2), Vec3(5, 5, 5)}, kPlaneBelow);
  EXPECT_LT(norm.straightness(), 1e-6);
  const AffineNorm point({Vec3(1, 1, 1), Vec3(1, 1, 1), Vec3(1, 1, 1), Vec3(1, 1, 1)}, kPlaneBelow);
  EXPECT_EQ(point.straightness(), 0);
}

}  // namespace
}  // namespace triglyph
