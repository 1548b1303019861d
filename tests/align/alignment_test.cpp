#include "engine/align/alignment.h"

#include <cmath>

#include <gtest/gtest.h>

#include "engine/attack/attack.h"
#include "engine/base/random.h"
#include "engine/geometry/box.h"
#include "engine/mesh/fewer_triangles.h"
#include "engine/samples/sample_shapes.h"
#include "tests/flux/flux_shapes.h"
#include "tests/support/arenas.h"
#include "tests/support/motions.h"
#include "tests/support/shapes.h"

namespace triglyph {
namespace {

Similarity some_motion(std::uint64_t seed, bool mirrored) {
  const auto draw = [&](std::uint64_t i) { return 2 * random_unit(seed, 1, i) - 1; };
  Similarity motion;
  motion.scale = std::exp(2 * draw(0));
  Vec3 x = Vec3(draw(1), draw(2), draw(3)).normalized();
  Vec3 y = Vec3(draw(4), draw(5), draw(6));
  y = (y - x * dot(x, y)).normalized();
  const Vec3 z = cross(x, y) * (mirrored ? -1.0 : 1.0);
  motion.rows = {x, y, z};
  motion.shift = Vec3(3 * draw(7), 3 * draw(8), 3 * draw(9));
  return motion;
}

Mesh moved_by(const Similarity& motion, Mesh mesh) {
  for (Vec3& point : mesh.positions) point = motion(point);
  return mesh;
}

// A shape without symmetries.
Mesh lopsided(std::uint32_t rows) {
  Mesh mesh = test::knobbly(rows);
  for (Vec3& p : mesh.positions) p[1] += 0.1 * std::sin(2 * p[1] + p[0]) + 0.05 * p[2] * p[1];
  return mesh;
}

// The farthest that a motion and its estimated inverse leave a point from where it was, in relation
// to the diagonal.
double error_of(const Similarity& motion, const Similarity& back, const Mesh& original) {
  double most = 0;
  for (const Vec3& point : original.positions) {
    most = std::max(most, (back(motion(point)) - point).norm());
  }
  return most / box_diagonal(original.positions);
}

TEST(Similarity, IsFittedToPairs) {
  const Mesh mesh = make_sample_shape(SampleShape::Closed, 300, 1);
  for (const bool mirrored : {false, true}) {
    const Similarity motion = some_motion(5, mirrored);
    std::vector<PointPair> pairs;
    for (const Vec3& point : mesh.positions) pairs.push_back({point, motion(point)});
    const auto fitted = fitted_similarity(pairs);
    ASSERT_TRUE(fitted);
    EXPECT_NEAR(fitted->scale, motion.scale, 1e-9);
    for (const PointPair& pair : pairs) EXPECT_LT(((*fitted)(pair.from) - pair.to).norm(), 1e-9);
    // first there and then back is nowhere
    std::vector<PointPair> back;
    for (const PointPair& pair : pairs) back.push_back({pair.to, pair.from});
    const Similarity both = combined(*fitted, *fitted_similarity(back));
    for (const Vec3& point : mesh.positions) EXPECT_LT((both(point) - point).norm(), 1e-9);
  }
  EXPECT_FALSE(fitted_similarity(std::vector<PointPair>(2)));
  const std::vector<PointPair> line = {{Vec3(0, 0, 0), Vec3(0, 0, 0)},
                                       {Vec3(1, 0, 0), Vec3(0, 1, 0)},
                                       {Vec3(2, 0, 0), Vec3(0, 2, 0)}};
  EXPECT_FALSE(fitted_similarity(line));
}

TEST(Alignment, UndoesAnyMotionOfAWholeMesh) {
  const Mesh original = lopsided(40);
  for (const char* attack : {"none", "noise:0.1", "simplify:50", "smooth:5"}) {
    const Mesh changed = Attack::parsed(attack).applied(original, 1);
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      const Similarity motion = some_motion(seed, seed % 2 == 0);
      const std::vector<Alignment> found = align(moved_by(motion, changed), original);
      ASSERT_FALSE(found.empty()) << attack << seed;
      EXPECT_GT(found[0].overlap, 0.95) << attack;
      const bool is_exact = std::string(attack) == "none";
      EXPECT_LT(error_of(motion, found[0].motion, original), is_exact ? 1e-6 : 2e-3)
          << attack << seed;
    }
  }
}

TEST(Alignment, OfASymmetricShapeIsBothWays) {
  const Mesh original = test::knobbly(40);  // its own mirror image
  const std::vector<Alignment> found = align(moved_by(some_motion(3, false), original), original);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_LT(std::min(error_of(some_motion(3, false), found[0].motion, original),
                     error_of(some_motion(3, false), found[1].motion, original)),
            1e-6);
}

TEST(Alignment, UndoesMotionsOfPieces) {
  const Mesh original = make_sample_shape(SampleShape::Closed, 6000, 3);
  for (const char* attack : {"crop:30", "crop:60", "crop:50+noise:0.05"}) {
    const Mesh piece = Attack::parsed(attack).applied(original, 7);
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const Similarity motion = some_motion(seed, seed == 2);
      const std::vector<Alignment> found = align(moved_by(motion, piece), original);
      ASSERT_FALSE(found.empty()) << attack << seed;
      EXPECT_LT(error_of(motion, found[0].motion, original), 1e-3) << attack << seed;
    }
  }
}

TEST(Alignment, FindsPiecesByLandmarksOfAMeshThatIsSimplified) {
  const Mesh original = make_sample_shape(SampleShape::Closed, 6000, 3);
  std::vector<std::uint64_t> numbers = landmarks(original);
  Mesh coarse{original.positions, clustered(original, 2000)};
  const Mesh piece = Attack::parsed("crop:50").applied(original, 7);
  const Similarity motion = some_motion(1, false);
  const std::vector<Alignment> found = align(moved_by(motion, piece), coarse, numbers);
  ASSERT_FALSE(found.empty());
  EXPECT_LT(error_of(motion, found[0].motion, original), 5e-3);
  std::fill(numbers.begin(), numbers.end(), 0);
  for (const Alignment& way : align(moved_by(motion, piece), coarse, numbers)) {
    EXPECT_GT(error_of(motion, way.motion, original), 5e-3);
  }
}

TEST(Alignment, OfWhatHasNothingToDoWithTheOriginalIsNone) {
  const Mesh original = test::knobbly(30);
  Mesh far = original;
  for (Vec3& point : far.positions) point = point + Vec3(100, 0, 0);
  far.triangles.resize(1);  // without a frame or neighbours
  EXPECT_TRUE(align(far, original).empty());
  EXPECT_TRUE(align({}, original).empty());
  EXPECT_TRUE(align(original, {}).empty());
  const Mesh flat{{Vec3(0, 0, 0), Vec3(0, 0, 0), Vec3(0, 0, 0)}, {{0, 1, 2}}};
  EXPECT_TRUE(align(original, flat).empty());
  const Mesh thin = moved_by(Similarity(), make_sample_shape(SampleShape::Open, 2000, 1));
  for (const Alignment& other : align(thin, original)) EXPECT_LT(other.overlap, 0.95);
}

TEST(Alignment, IsTheSameForAnyThreads) {
  const Mesh original = make_sample_shape(SampleShape::Closed, 2000, 3);
  const Mesh piece =
      moved_by(some_motion(3, true), Attack::parsed("crop:40+noise:0.1").applied(original, 2));
  test::expect_same_for_any_threads([&] {
    std::vector<double> numbers;
    for (const Alignment& found : align(piece, original)) {
      numbers.insert(numbers.end(), {found.motion.scale, found.rms, found.motion.shift[0]});
    }
    return numbers;
  });
}

TEST(Alignment, FindsFewPointsAmongMany) {
  const Mesh mesh = make_sample_shape(SampleShape::Closed, 100, 2);
  const std::vector<Vec3> targets = {mesh.positions[3], mesh.positions[40], mesh.positions[17],
                                     mesh.positions[25]};
  for (const bool mirrored : {false, true}) {
    const Similarity motion = some_motion(2, mirrored);
    const std::vector<Similarity> ways = ways_onto(moved_by(motion, mesh).positions, targets, 5);
    ASSERT_FALSE(ways.empty());
    EXPECT_LT(error_of(motion, ways[0], mesh), 1e-9);
    EXPECT_LE(ways.size(), 5U);
  }
  EXPECT_TRUE(ways_onto(mesh.positions, std::span(targets).first(2), 5).empty());
}

TEST(Alignment, SeesWhereTheSurfaceIsAndWhereItIsGone) {
  const Mesh original = test::knobbly(40);
  const double diagonal = box_diagonal(original.positions);
  Mesh swollen = original;
  std::vector<Vec3> normals(original.positions.size(), Vec3(0, 0, 0));
  for (const Triangle& t : original.triangles) {
    for (const std::uint32_t point : t) normals[point] += area_normal(original.positions, t);
  }
  for (std::size_t i = 0; i < normals.size(); ++i) {
    swollen.positions[i] += normals[i].normalized() * (1e-3 * diagonal);
  }
  Mesh part{swollen.positions, {}};
  for (const Triangle& t : swollen.triangles) {
    if (swollen.positions[t[0]][0] < 0) part.triangles.push_back(t);
  }
  const auto places = places_on(original, part, Similarity(), 0.005 * diagonal);
  std::size_t seen = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double x = original.positions[i][0];
    if (x > 0.05 * diagonal) {
      EXPECT_FALSE(places[i]) << i;
    }
    if (x > -0.05 * diagonal || !places[i]) continue;
    ++seen;
    EXPECT_NEAR((*places[i] - original.positions[i]).norm(), 1e-3 * diagonal, 2e-4 * diagonal);
  }
  EXPECT_GT(seen, places.size() / 3);
  const auto nearest = nearest_points(original, swollen, Similarity(), 0.002 * diagonal);
  for (std::size_t i = 0; i < nearest.size(); ++i) {
    ASSERT_TRUE(nearest[i]);
    EXPECT_EQ(*nearest[i], swollen.positions[i]);
  }
}

}  // namespace
}  // namespace triglyph
