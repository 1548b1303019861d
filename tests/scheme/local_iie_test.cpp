#include "engine/scheme/iie/local_iie.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "engine/marking/extract.h"
#include "engine/marking/mark.h"
#include "engine/samples/sample_shapes.h"
#include "engine/scheme/iie/sites.h"
#include "engine/scheme/registry.h"
#include "tests/support/arenas.h"
#include "tests/support/attacks.h"
#include "tests/support/shapes.h"

namespace triglyph {
namespace {

const Message kLocalMessage{'l', 'o', 'c', 'a', 'l', ' ', '8', '!'};

struct LocallyMarked {
  MarkOptions options = default_mark_options("iie", false);
  test::Solid original{make_sample_shape(SampleShape::Closed, 40000, 21)};
  Marking marking =
      mark(original.surface(), kLocalMessage, Key::trial(), options, test::as_float, 1e-7);
  Mesh mesh{marking.positions, original.mesh.triangles};

  [[nodiscard]] Extraction read(const Mesh& other) const {
    const test::Solid solid(other);
    return extract(solid.surface(), options.encoding(), Key::trial());
  }
};

const LocallyMarked& locally_marked() {
  static const LocallyMarked marked;
  return marked;
}

TEST(LocalIie, MessageSurvivesNoiseQuantisationAndCropping) {
  ASSERT_EQ(locally_marked().marking.status, MarkStatus::Marked);
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    EXPECT_EQ(
        locally_marked().read(test::with_uniform_noise(locally_marked().mesh, 0.001, seed)).message,
        kLocalMessage);
    EXPECT_EQ(locally_marked().read(test::cropped_half(locally_marked().mesh, seed)).message,
              kLocalMessage);
  }
  EXPECT_EQ(locally_marked().read(test::quantised(locally_marked().mesh, 10)).message,
            kLocalMessage);
  EXPECT_FALSE(locally_marked().read(locally_marked().original.mesh).message);
}

// Moves are bumps of a few cells: where a message was embedded as it came they were ten times that.
TEST(LocalIie, MovesAreLowAndSmooth) {
  double farthest = 0;
  for (std::size_t i = 0; i < locally_marked().mesh.positions.size(); ++i) {
    const Vec3 move =
        locally_marked().mesh.positions[i] - locally_marked().original.mesh.positions[i];
    farthest = std::max(farthest, move.norm());
  }
  EXPECT_GT(farthest, 0);
  EXPECT_LT(farthest, 0.005);  // of a ball of radius 1
  double steepest = 0;
  for (const Triangle& t : locally_marked().mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = t[i], b = t[(i + 1) % 3];
      const Vec3 rise =
          (locally_marked().mesh.positions[a] - locally_marked().original.mesh.positions[a]) -
          (locally_marked().mesh.positions[b] - locally_marked().original.mesh.positions[b]);
      const double run = (locally_marked().original.mesh.positions[a] -
                          locally_marked().original.mesh.positions[b])
                             .norm();
      steepest = std::max(steepest, rise.norm() / run);
    }
  }
  EXPECT_LT(steepest, 0.1);
}

// Sites without a mark vote at random; so few are left that they do not matter.
TEST(LocalIie, NearlyAllSitesCarryAWord) {
  const Extraction found = locally_marked().read(locally_marked().mesh);
  EXPECT_GT(found.agreeing, 0.8 * static_cast<double>(found.readings.size()));
  EXPECT_GE(found.agreeing, locally_marked().marking.carriers.size());
}

// What is cut off elsewhere changes the mean edge length of the mesh, but not that about a site.
TEST(LocalIie, SharesDoNotDependOnTheRestOfTheMesh) {
  const auto shares_of = [](const Mesh& mesh) {
    const test::Solid solid(mesh);
    const SpatialIndex index(mesh.positions, mesh.triangles);
    const IieSites sites = scatter_sites(solid.halfedges, mesh.positions.size(), 7, 3);
    const LocalGround ground{solid.surface(), index, sites.at_boundary, 3, 0, 1};
    std::map<std::array<double, 3>, double> shares;
    for (const std::uint32_t site : sites.points) {
      const Vec3& p = mesh.positions[site];
      const double share = sphere_share(ground, site);
      if (std::isfinite(share)) shares[{p[0], p[1], p[2]}] = share;
    }
    return shares;
  };
  const auto whole = shares_of(locally_marked().mesh);
  std::size_t common = 0;
  const auto half = shares_of(test::cropped_half(locally_marked().mesh, 1));
  for (const auto& [place, share] : half) {
    const auto at = whole.find(place);
    if (at == whole.end()) continue;
    EXPECT_NEAR(at->second, share, 1e-12);
    ++common;
  }
  EXPECT_GT(2 * common, half.size());
}

TEST(LocalIie, AnEmbeddedShareIsThatOfItsCellToAMillionth) {
  const WordCode code(Key::trial(), IieOptions::format(false));
  const LocalIieScheme scheme(code, IieOptions::defaults(false));
  const auto bound = scheme.bind(locally_marked().original.surface());
  const UnitSet units = bound->find_units();
  ASSERT_GT(units.size(), 20U);
  const std::vector<Word> words = code.words_of(kLocalMessage);
  const std::vector<std::uint32_t> one{static_cast<std::uint32_t>(units.size() / 2)};
  const CostMatrix costs = bound->costs(units, one, words);
  std::size_t feasible = 0;
  for (std::uint32_t word = 0; word < words.size(); ++word) {
    if (costs.at(0, word) == kInfeasible) continue;
    ++feasible;
    const Placement placement{one[0], word};
    const Embedding embedding = bound->embed(units, {&placement, 1}, words);
    ASSERT_TRUE(embedding.failed.empty());
    const Mesh moved{embedding.positions, locally_marked().original.mesh.triangles};
    const std::uint32_t anchor = units.anchors[one[0]];
    const auto readings =
        bound->moved_to({moved, locally_marked().original.halfedges})->read_at({&anchor, 1});
    ASSERT_EQ(readings.size(), 1U);
    EXPECT_EQ(readings[0].word, words[word]);
    EXPECT_LT(readings[0].worst_offset, 1e-5F);
    double farthest = 0;
    for (std::size_t i = 0; i < moved.positions.size(); ++i) {
      farthest = std::max(
          farthest, (moved.positions[i] - locally_marked().original.mesh.positions[i]).norm());
    }
    EXPECT_NEAR(costs.at(0, word), farthest, 0.02 * farthest);
  }
  EXPECT_EQ(feasible, 1U);  // the site's own subscript
}

TEST(LocalIie, RefusesWhatCannotBe) {
  const auto refuses = [](const WordFormat& format, const IieOptions& options) {
    EXPECT_THROW(LocalIieScheme(WordCode(Key::trial(), format), options), Error);
  };
  refuses({8, 9, 9, true}, IieOptions::defaults(false));
  IieOptions options = IieOptions::defaults(false);
  options.centre_rings = 4;
  refuses({0, 10, 3, true}, options);
  EXPECT_THROW(
      (void)resolve(
          {{"scheme", std::string("iie")}, {"fill", true}, {"iie_encoding", std::string("local")}}),
      Error);
}

std::set<std::uint32_t> set_of(const IieSites& sites) {
  return {sites.points.begin(), sites.points.end()};
}

TEST(ScatteredSites, LieApartAndLeaveNoRoom) {
  const auto& ball = test::large_ball();
  const std::size_t points = ball.mesh.positions.size();
  const IieSites sites = scatter_sites(ball.halfedges, points, 5, 1);
  const std::set<std::uint32_t> all = set_of(sites);
  EXPECT_GT(all.size(), points / 150);
  std::set<std::uint32_t> covered;
  for (const std::uint32_t site : sites.points) {
    const auto near = points_within(ball.halfedges, site, 5).value();
    for (const std::uint32_t point : near) {
      EXPECT_TRUE(point == site || all.count(point) == 0);
      covered.insert(point);
    }
  }
  EXPECT_GT(covered.size(), points * 95 / 100);  // but for points that many are like
  EXPECT_EQ(sites.signatures.size(), sites.points.size());
}

TEST(ScatteredSites, AreThoseOfNoisyTurnedAndMirroredMeshes) {
  const auto& ball = test::bumpy_ball();
  const std::size_t points = ball.mesh.positions.size();
  const auto sites_of = [&](const Mesh& mesh) {
    const IieSites sites = scatter_sites(build_halfedges(mesh), points, 4, 1);
    return std::pair(sites.points, sites.signatures);
  };
  const auto expected = sites_of(ball.mesh);
  EXPECT_GT(expected.first.size(), 10U);
  EXPECT_EQ(sites_of(test::with_uniform_noise(ball.mesh, 0.01, 1)), expected);
  EXPECT_EQ(sites_of(test::turned_inside_out(ball.mesh)), expected);
  auto signatures = sites_of(test::shuffled(ball.mesh, 1)).second;
  auto expected_signatures = expected.second;
  std::sort(signatures.begin(), signatures.end());
  std::sort(expected_signatures.begin(), expected_signatures.end());
  EXPECT_EQ(signatures, expected_signatures);
}

TEST(ScatteredSites, AreNoneOnARegularGrid) {
  const Mesh grid = test::flat_grid(40, 40);
  EXPECT_TRUE(scatter_sites(build_halfedges(grid), grid.positions.size(), 4, 1).points.empty());
}

TEST(LocalIie, MarksAreTheSameForAnyThreads) {
  test::expect_same_for_any_threads([] {
    const Marking marking = mark(locally_marked().original.surface(), kLocalMessage, Key::trial(),
                                 locally_marked().options, test::as_float, 1e-7);
    return std::pair(marking.positions, marking.carriers);
  });
}

}  // namespace
}  // namespace triglyph
