#include "engine/scheme/tsq.h"

#include <set>

#include <gtest/gtest.h>

#include "engine/base/random.h"
#include "engine/layout/layout.h"
#include "tests/support/arenas.h"
#include "tests/support/attacks.h"
#include "tests/support/shapes.h"

namespace triglyph {
namespace {

const WordCode& code() {
  static const WordCode code(Key::trial(), {6, 8, 9});
  return code;
}

struct Chosen {
  UnitSet units;
  std::vector<std::uint32_t> valid;
};

Chosen choose(const Scheme& scheme, const Surface& surface) {
  Chosen chosen{scheme.find_units(surface), {}};
  const Conflicts conflicts(chosen.units, surface.mesh.positions.size(), ConflictRule::ReadWrite);
  chosen.valid = choose_layout(conflicts, {});
  return chosen;
}

std::vector<Placement> random_placements(const Chosen& chosen, std::size_t words) {
  std::vector<Placement> placements;
  for (const std::uint32_t unit : chosen.valid) {
    placements.push_back({unit, static_cast<std::uint32_t>(random_bits(1, 2, unit) % words)});
  }
  return placements;
}

TEST(Tsq, UnitsAreSixDistinctPointsInOrder) {
  const TsqScheme scheme(code(), {});
  const auto& ball = test::bumpy_ball();
  const UnitSet units = scheme.find_units(ball.surface());
  EXPECT_GT(units.size(), ball.mesh.triangles.size() * 9 / 10);
  EXPECT_TRUE(std::is_sorted(units.anchors.begin(), units.anchors.end()));
  for (std::size_t i = 0; i < units.size(); ++i) {
    const auto points = units.moved[i];
    EXPECT_EQ(std::set<std::uint32_t>(points.begin(), points.end()).size(), 6U);
  }
}

TEST(Tsq, EveryPlacedWordIsReadBackAtItsAnchor) {
  const TsqScheme scheme(code(), {});
  const auto& ball = test::bumpy_ball();
  const Chosen chosen = choose(scheme, ball.surface());
  const auto words = code().fill_words(256);
  const auto placements = random_placements(chosen, words.size());
  const Embedding embedding = scheme.embed(ball.surface(), chosen.units, placements, words);
  const Mesh marked{embedding.positions, ball.mesh.triangles};
  const auto readings = scheme.read({marked, ball.halfedges});

  const std::set<std::uint32_t> failed(embedding.failed.begin(), embedding.failed.end());
  EXPECT_LT(failed.size(), placements.size() / 20);
  for (std::uint32_t i = 0; i < placements.size(); ++i) {
    if (failed.count(i) != 0) continue;
    const std::uint32_t anchor = chosen.units.anchors[placements[i].unit];
    const auto at = std::lower_bound(
        readings.begin(), readings.end(), anchor,
        [](const Reading& reading, std::uint32_t a) { return reading.anchor < a; });
    ASSERT_TRUE(at != readings.end() && at->anchor == anchor);
    EXPECT_EQ(at->word, words[placements[i].word]);
    EXPECT_LT(at->worst_offset, 1e-4);
    EXPECT_GT(at->weight, 0.999);
  }
}

TEST(Tsq, CostIsTheFarthestMoveOfTheUnit) {
  const auto& ball = test::bumpy_ball();
  const auto words = code().fill_words(64);
  for (const CostFunction cost : {CostFunction::Displacement, CostFunction::Rms}) {
    SchemeOptions options;
    options.cost = cost;
    const TsqScheme scheme(code(), options);
    const Chosen chosen = choose(scheme, ball.surface());
    const CostMatrix costs = scheme.costs(ball.surface(), chosen.units, chosen.valid, words);
    const auto placements = random_placements(chosen, words.size());
    const Embedding embedding = scheme.embed(ball.surface(), chosen.units, placements, words);
    const std::set<std::uint32_t> failed(embedding.failed.begin(), embedding.failed.end());
    for (std::uint32_t i = 0; i < placements.size(); ++i) {
      const float expected = costs.at(i, placements[i].word);
      EXPECT_EQ(expected == kInfeasible, failed.count(i) != 0);
      if (failed.count(i) != 0) continue;
      double farthest = 0, sum = 0;
      for (const std::uint32_t point : chosen.units.moved[placements[i].unit]) {
        const double move = (embedding.positions[point] - ball.mesh.positions[point]).norm();
        farthest = std::max(farthest, move);
        sum += move * move;
      }
      const double actual = cost == CostFunction::Displacement ? farthest : std::sqrt(sum / 6);
      EXPECT_NEAR(actual, expected, 1e-5 * actual + 1e-9);
    }
  }
}

TEST(Tsq, ReadsTheSameUnderAnySimilarityAndOrder) {
  const TsqScheme scheme(code(), {});
  const auto& ball = test::bumpy_ball();
  const Chosen chosen = choose(scheme, ball.surface());
  const auto words = code().fill_words(256);
  const Embedding embedding =
      scheme.embed(ball.surface(), chosen.units, random_placements(chosen, words.size()), words);
  const auto good_words = [&](const Mesh& mesh) {
    std::multiset<std::pair<std::uint32_t, std::uint32_t>> found;
    const test::Solid solid(mesh);
    for (const Reading& reading : scheme.read(solid.surface())) {
      if (reading.worst_offset < 0.1) found.insert({reading.word.subscript, reading.word.part});
    }
    return found;
  };
  const Mesh marked{embedding.positions, ball.mesh.triangles};
  const auto expected = good_words(marked);
  EXPECT_GT(expected.size(), chosen.valid.size() * 9 / 10);
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    EXPECT_EQ(good_words(test::shuffled(marked, seed)), expected);
    EXPECT_EQ(good_words(test::moved_rigidly_and_scaled(marked, seed)), expected);
  }
}

TEST(Tsq, BoundariesAndTinyMeshesOfferNothing) {
  const TsqScheme scheme(code(), {});
  const test::Solid tetrahedron(test::tetrahedron());  // neighbours share their apexes
  EXPECT_EQ(scheme.find_units(tetrahedron.surface()).size(), 0U);
  const test::Solid grid(test::flat_grid(1, 1));
  EXPECT_EQ(scheme.find_units(grid.surface()).size(), 0U);
  const test::Solid empty(Mesh{});
  EXPECT_EQ(scheme.find_units(empty.surface()).size(), 0U);
  EXPECT_TRUE(scheme.read(empty.surface()).empty());
}

TEST(Tsq, DegenerateTrianglesAreNeitherUnitsNorTrouble) {
  Mesh mesh = test::flat_grid(6, 6);
  for (std::size_t i = 0; i < mesh.positions.size(); i += 2) mesh.positions[i] = Vec3(1, 1, 0);
  for (std::size_t i = 1; i < mesh.positions.size(); i += 6) mesh.positions[i][0] += 1e-300;
  const test::Solid solid(mesh);
  const TsqScheme scheme(code(), {});
  const UnitSet units = scheme.find_units(solid.surface());
  for (const Reading& reading : scheme.read(solid.surface())) {
    EXPECT_TRUE(std::isfinite(reading.weight));
  }
  std::vector<std::uint32_t> all(units.size());
  std::iota(all.begin(), all.end(), 0U);
  const auto words = code().fill_words(4);
  for (const float cost : scheme.costs(solid.surface(), units, all, words).values) {
    EXPECT_FALSE(std::isnan(cost));
  }
}

TEST(Tsq, ResultsDoNotDependOnThreads) {
  const TsqScheme scheme(code(), {});
  const auto& ball = test::bumpy_ball();
  const auto words = code().fill_words(100);
  test::expect_same_for_any_threads([&] {
    const Chosen chosen = choose(scheme, ball.surface());
    const auto costs = scheme.costs(ball.surface(), chosen.units, chosen.valid, words);
    const auto embedding =
        scheme.embed(ball.surface(), chosen.units, random_placements(chosen, words.size()), words);
    return std::make_tuple(chosen.units.anchors, chosen.units.moved.points, costs.values,
                           embedding.positions, embedding.failed);
  });
}

}  // namespace
}  // namespace triglyph
