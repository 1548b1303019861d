// Attacks that move, list or take away what is there.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include <gtest/gtest.h>

#include "engine/attack/coordinates.h"
#include "engine/attack/indexing.h"
#include "engine/attack/motions.h"
#include "engine/attack/parts.h"
#include "engine/attack/stored_mesh.h"
#include "engine/geometry/box.h"
#include "engine/mesh/edge_length.h"
#include "tests/attack/measures.h"
#include "tests/support/shapes.h"

namespace triglyph {
namespace {

using test::ball;
using test::volume_of;

// The triangles by their corners' coordinates, each from its least corner on, sorted.
using Corner = std::array<double, 3>;
std::vector<std::array<Corner, 3>> shape_of(const Mesh& mesh) {
  std::vector<std::array<Corner, 3>> shape;
  for (const Triangle& t : mesh.triangles) {
    std::array<Corner, 3> corners;
    for (std::size_t i = 0; i < 3; ++i) corners[i] = mesh.positions[t[i]].values;
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    shape.push_back(corners);
  }
  std::sort(shape.begin(), shape.end());
  return shape;
}

TEST(Noise, IsUniformUpToTheIntensityTimesTheMeanDistanceFromTheCentroid) {
  Vec3 centroid(0, 0, 0);
  for (const Vec3& p : ball().positions) centroid += p;
  centroid /= double(ball().positions.size());
  double mean = 0;
  for (const Vec3& p : ball().positions) mean += (p - centroid).norm();
  mean /= double(ball().positions.size());
  const Mesh noisy = with_uniform_noise(ball(), 0.003, 9);
  EXPECT_EQ(noisy.triangles, ball().triangles);
  double farthest = 0;
  double squares = 0;
  for (std::size_t i = 0; i < noisy.positions.size(); ++i) {
    const Vec3 move = noisy.positions[i] - ball().positions[i];
    farthest = std::max(farthest, move.max_abs());
    squares += move.sqrnorm();
  }
  EXPECT_LE(farthest, 0.003 * mean * (1 + 1e-9));
  EXPECT_GT(farthest, 0.00299 * mean);
  // the variance of a coordinate is a third of its square
  EXPECT_NEAR(squares / double(noisy.positions.size()), 0.003 * 0.003 * mean * mean,
              0.03 * 0.003 * 0.003 * mean * mean);
}

TEST(Smoothing, MovesAPointATenthOfTheWayToTheMeanOfItsNeighbours) {
  Mesh grid = test::flat_grid(4, 4);
  grid.positions[12][2] = 1;  // the middle one, with six neighbours
  const Mesh once = smoothed(grid, 1);
  EXPECT_NEAR(once.positions[12][2], 0.9, 1e-15);
  EXPECT_NEAR(once.positions[7][2], 0.1 / 6, 1e-15);
  EXPECT_EQ(once.positions[1][2], 0);
  EXPECT_EQ(smoothed(once, 2).positions, smoothed(grid, 3).positions);
  EXPECT_LT(volume_of(smoothed(ball(), 50)), volume_of(ball()));
}

TEST(Quantisation, LeavesTheValuesOfTheBitsAlongEachAxis) {
  for (const int bits : {4, 7, 9}) {
    const Mesh coarse = quantised(ball(), bits);
    const auto [low, high] = bounding_box(ball().positions);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::set<double> values;
      double farthest = 0;
      for (std::size_t i = 0; i < coarse.positions.size(); ++i) {
        values.insert(coarse.positions[i][axis]);
        farthest =
            std::max(farthest, std::abs(coarse.positions[i][axis] - ball().positions[i][axis]));
      }
      EXPECT_LE(values.size(), (std::size_t{1} << bits) + 1);
      EXPECT_GT(values.size(), std::size_t{1} << (bits - 1));
      EXPECT_LE(farthest, (high[axis] - low[axis]) / std::ldexp(2, bits) * (1 + 1e-9));
    }
  }
}

TEST(Quantisation, ToCubesHasOneStepAndNoMoreValuesThanTheBitsNumber) {
  Mesh flat = ball();
  for (Vec3& p : flat.positions) p[1] /= 8;
  const Mesh coarse = quantised_to_cubes(flat, 6);
  const Vec3 size = bounding_box(flat.positions).size();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::set<double> values;
    for (const Vec3& p : coarse.positions) values.insert(p[axis]);
    EXPECT_LE(values.size(), 64U);
    const double step = (*values.rbegin() - *values.begin()) / double(values.size() - 1);
    EXPECT_NEAR(step, size.max() / 63, 1e-9 * size.max());  // no value is left out
  }
}

TEST(Digits, AreAsManyAsAskedFor) {
  EXPECT_EQ(with_significant_digits(Vec3(0.1234567, -98765.4321, 1e-9), 4),
            Vec3(0.1235, -98770, 1e-9));
}

TEST(HalfFloats, AreThoseOfTheStandard) {
  // the box from -1 to 1 stays where it is
  Mesh mesh{{Vec3(-1, -1, -1), Vec3(1, 1, 1), Vec3(0.1, 1.0 / 3, 1e-6), Vec3(0.7, 3e-8, -0.2)}, {}};
  const Mesh half = as_half_floats(mesh);
  EXPECT_EQ(half.positions[0], mesh.positions[0]);
  EXPECT_EQ(half.positions[2], Vec3(0x1.998p-4, 0x1.554p-2, 0x1.1p-20));  // the last: subnormal
  EXPECT_EQ(half.positions[3], Vec3(0x1.668p-1, 0x1p-24, -0x1.998p-3));
}

TEST(Reordering, KeepsTheShapeAndNothingOfTheOrder) {
  const Mesh other = reordered(ball(), 3);
  EXPECT_EQ(shape_of(other), shape_of(ball()));
  std::vector<Corner> points;
  std::vector<Corner> others;
  std::size_t in_place = 0;
  for (std::size_t i = 0; i < ball().positions.size(); ++i) {
    points.push_back(ball().positions[i].values);
    others.push_back(other.positions[i].values);
    in_place += points.back() == others.back() ? 1 : 0;
  }
  EXPECT_LT(in_place, 20U);
  std::sort(points.begin(), points.end());
  std::sort(others.begin(), others.end());
  EXPECT_EQ(points, others);
}

TEST(Soup, IsTheSameShapeOnceItIsStored) {
  const Mesh soup = as_soup(ball());
  EXPECT_EQ(soup.positions.size(), 3 * ball().triangles.size());
  const Mesh read = stored(soup);
  EXPECT_EQ(read.positions.size(), stored(ball()).positions.size());
  EXPECT_EQ(shape_of(read), shape_of(stored(ball())));
}

TEST(Stored, MeshesHaveFloatsAndNoTwoPointsAtOnePlace) {
  const Mesh mesh{{Vec3(0.1, 0, 0), Vec3(0.1 + 1e-12, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)},
                  {{0, 2, 3}, {1, 2, 3}, {0, 1, 3}}};
  const Mesh read = stored(mesh);
  ASSERT_EQ(read.positions.size(), 3U);
  EXPECT_EQ(read.positions[0][0], double(0.1F));
  EXPECT_EQ(read.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 1, 2}}));
}

TEST(Welding, JoinsPointsCloserThanTheToleranceAndNoOthers) {
  Mesh mesh = test::flat_grid(2, 1);
  const double diagonal = std::sqrt(5.0);
  mesh.positions.push_back(mesh.positions[4] + Vec3(0.001, 0, 0));
  mesh.triangles.push_back({0, 1, 6});
  mesh.triangles.push_back({4, 6, 5});
  EXPECT_EQ(welded(mesh, 0.0009 / diagonal).positions.size(), 7U);
  const Mesh joined = welded(mesh, 0.0011 / diagonal);
  EXPECT_EQ(joined.positions.size(), 6U);
  EXPECT_EQ(joined.triangles.size(), 5U);  // the sliver is gone
  EXPECT_EQ(joined.triangles.back(), (Triangle{0, 1, 4}));
}

TEST(Motions, KeepWhatTheySay) {
  const double volume = volume_of(ball());
  const Mesh similar = similarly_mapped(ball(), 4);
  const double scale = mean_edge_length(similar) / mean_edge_length(ball());
  EXPECT_NEAR(volume_of(similar), scale * scale * scale * volume, 1e-6 * volume_of(similar));
  EXPECT_GT(std::abs(scale - 1), 0.1);
  const Mesh image = mirrored(ball());
  EXPECT_NEAR(volume_of(image), volume, 1e-9);
  EXPECT_NEAR(volume_of(flipped(ball())), -volume, 1e-9);
  EXPECT_EQ(shape_of(mirrored(image)), shape_of(ball()));
}

TEST(AffineMaps, StretchAsFarAsAskedFor) {
  // the images of many directions: the longest and the shortest of them
  Mesh sphere{{Vec3(0, 0, 0)}, {}};
  for (std::uint64_t i = 0; i < 20000; ++i) sphere.positions.push_back(random_rotation(i)[0]);
  const Mesh stretched = affinely_mapped(sphere, 3, 8);
  double longest = 0;
  double shortest = 1e9;
  for (const Vec3& p : stretched.positions) {
    const double length = (p - stretched.positions[0]).norm();
    if (length == 0) continue;
    longest = std::max(longest, length);
    shortest = std::min(shortest, length);
  }
  EXPECT_NEAR(longest, 3, 0.01);
  EXPECT_NEAR(shortest, 1, 0.02);
}

TEST(Cropping, KeepsTheShareAndTheCoordinates) {
  const auto all = double(ball().triangles.size());
  const auto whole = shape_of(ball());
  for (const double share : {0.0, 0.1, 0.3, 0.5, 0.9}) {
    const Mesh left = cropped(ball(), share, 6);
    EXPECT_EQ(left.triangles.size(), std::size_t(std::llround((1 - share) * all)));
    const auto part = shape_of(left);
    EXPECT_TRUE(std::includes(whole.begin(), whole.end(), part.begin(), part.end()));
  }
  EXPECT_NE(shape_of(cropped(ball(), 0.5, 7)), shape_of(cropped(ball(), 0.5, 8)));
}

TEST(AddedBall, LiesApartAndHasEdgesAsLong) {
  const Mesh both = with_added_ball(ball(), 0.2, 2);
  const auto old = std::ptrdiff_t(ball().triangles.size());
  EXPECT_NEAR(double(both.triangles.size()), 1.2 * double(old), 0.02 * double(old));
  EXPECT_TRUE(std::equal(ball().triangles.begin(), ball().triangles.end(), both.triangles.begin()));
  const Mesh added =
      compacted(both.positions, {both.triangles.begin() + old, both.triangles.end()});
  EXPECT_NEAR(mean_edge_length(added), mean_edge_length(ball()), 1e-9);
  const Box first = bounding_box(ball().positions);
  const Box second = bounding_box(added.positions);
  const double between = ((first.low + first.high) / 2 - (second.low + second.high) / 2).norm();
  EXPECT_GT(between, (first.size().norm() + second.size().norm()) / 2);
}

}  // namespace
}  // namespace triglyph
