// What every scheme promises, whatever its invariants are.
#include <numeric>
#include <set>

#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "engine/base/random.h"
#include "engine/layout/layout.h"
#include "engine/marking/mark.h"
#include "engine/scheme/registry.h"
#include "tests/support/arenas.h"
#include "tests/support/attacks.h"
#include "tests/support/shapes.h"

namespace triglyph {
namespace {

// As many words as a test wants; where a place fixes the subscript, one of each.
std::vector<Word> words_of(const WordCode& code, std::uint32_t count) {
  return code.fill_words(code.format().is_spread ? code.capacity()
                                                 : std::min(code.capacity(), count));
}

// The schemes by name, and the encoding of iie that the first generation and fill use.
constexpr std::string_view kGlobalIie = "iie_global";
constexpr std::array<std::string_view, 4> kSchemes = {"tsq", "aie", "iie", kGlobalIie};

class EveryScheme : public testing::TestWithParam<std::string_view> {
 protected:
  static std::string name() { return GetParam() == kGlobalIie ? "iie" : std::string(GetParam()); }
  static bool is_iie() { return name() == "iie"; }
  static SchemeDefaults defaults() {
    if (GetParam() == kGlobalIie) return scheme_info("iie").older().at(0);
    return scheme_info(name()).defaults(false, Strength::Normal);
  }

  // Every place is a candidate, sizes are fixed: what is embedded is read to the last bit.
  [[nodiscard]] std::unique_ptr<Scheme> scheme(CostFunction cost = {}) const {
    return make_scheme(name(), code_, fixed_for(test::bumpy_ball().mesh, relative_), cost);
  }
  [[nodiscard]] std::unique_ptr<Scheme> relative_scheme() const {
    return make_scheme(name(), code_, relative_);
  }

  static OptionValues every_place() {
    OptionValues options = defaults().options;
    if (!is_iie()) return options;
    options["radius_edges"] = 3.5;
    options["site_rings"] = std::int64_t{0};
    return options;
  }

  OptionValues relative_ = every_place();
  WordCode code_{Key::trial(), defaults().format};
  double cost_precision_ = is_iie() ? 0.02 : 1e-5;  // see IieScheme::costs
};
INSTANTIATE_TEST_SUITE_P(All, EveryScheme, testing::ValuesIn(kSchemes),
                         [](const auto& scheme) { return std::string(scheme.param); });

struct Chosen {
  UnitSet units;
  std::vector<std::uint32_t> valid;
};

Chosen choose(const BoundScheme& scheme, const Surface& surface) {
  Chosen chosen{scheme.find_units(), {}};
  const Conflicts conflicts(chosen.units.moved, chosen.units.read_or_moved(),
                            surface.mesh.positions.size(), ConflictRule::ReadWrite);
  chosen.valid = choose_layout(conflicts, {});
  return chosen;
}

// A word that each unit can carry, drawn at random; units without any are left out.
std::vector<Placement> random_placements(const BoundScheme& scheme, const Chosen& chosen,
                                         std::span<const Word> words) {
  const CostMatrix costs = scheme.costs(chosen.units, chosen.valid, words);
  const auto count = static_cast<std::uint32_t>(words.size());
  std::vector<Placement> placements;
  for (std::uint32_t i = 0; i < chosen.valid.size(); ++i) {
    const auto start = static_cast<std::uint32_t>(random_bits(1, 2, i) % count);
    for (std::uint32_t k = 0; k < count; ++k) {
      const std::uint32_t word = (start + k) % count;
      if (costs.at(i, word) == kInfeasible) continue;
      placements.push_back({chosen.valid[i], word});
      break;
    }
  }
  return placements;
}

TEST_P(EveryScheme, AnchorsAscendAndUnitsReadWhatTheyMove) {
  const auto& ball = test::bumpy_ball();
  const UnitSet units = scheme()->bind(ball.surface())->find_units();
  EXPECT_GT(units.size(), 500U);
  EXPECT_EQ(std::adjacent_find(units.anchors.begin(), units.anchors.end(), std::greater_equal()),
            units.anchors.end());
  for (std::size_t i = 0; i < units.size(); ++i) {
    const auto moved = units.moved[i];
    const auto read = units.read_or_moved()[i];
    const std::set<std::uint32_t> reads(read.begin(), read.end());
    EXPECT_FALSE(moved.empty());
    EXPECT_EQ(reads.size(), read.size());
    for (const std::uint32_t point : moved) EXPECT_EQ(reads.count(point), 1U);
  }
}

TEST_P(EveryScheme, EveryPlacedWordIsReadBackAtItsAnchor) {
  const auto& ball = test::bumpy_ball();
  const auto scheme = this->scheme();
  const auto bound = scheme->bind(ball.surface());
  const Chosen chosen = choose(*bound, ball.surface());
  const auto words = words_of(code_, 256);
  const auto placements = random_placements(*bound, chosen, words);
  const Embedding embedding = bound->embed(chosen.units, placements, words);
  const Mesh marked{embedding.positions, ball.mesh.triangles};
  const auto readings = scheme->bind({marked, ball.halfedges})->read();

  EXPECT_GT(placements.size(), chosen.valid.size() * 9 / 10);
  EXPECT_TRUE(embedding.failed.empty());
  std::size_t exact = 0;
  for (std::uint32_t i = 0; i < placements.size(); ++i) {
    const std::uint32_t anchor = chosen.units.anchors[placements[i].unit];
    const auto at = std::lower_bound(
        readings.begin(), readings.end(), anchor,
        [](const Reading& reading, std::uint32_t a) { return reading.anchor < a; });
    ASSERT_TRUE(at != readings.end() && at->anchor == anchor);
    EXPECT_EQ(at->word, words[placements[i].word]);
    EXPECT_LT(at->worst_offset, 0.2);
    exact += at->worst_offset < 1e-4 && at->weight > 0.999 ? 1 : 0;
  }
  // a unit of iie may see a sheet move that it did not see before it moved itself
  EXPECT_GE(exact * 100, placements.size() * (is_iie() ? 90 : 100));
}

TEST_P(EveryScheme, CostIsTheMoveOfTheUnit) {
  const auto& ball = test::bumpy_ball();
  const auto words = words_of(code_, 64);
  for (const CostFunction cost : {CostFunction::Displacement, CostFunction::Rms}) {
    const auto scheme = this->scheme(cost);
    const auto bound = scheme->bind(ball.surface());
    const Chosen chosen = choose(*bound, ball.surface());
    const CostMatrix costs = bound->costs(chosen.units, chosen.valid, words);
    const auto placements = random_placements(*bound, chosen, words);
    const Embedding embedding = bound->embed(chosen.units, placements, words);
    EXPECT_TRUE(embedding.failed.empty());
    std::uint32_t row = 0;
    for (const Placement& placement : placements) {
      while (chosen.valid[row] != placement.unit) ++row;
      const float expected = costs.at(row, placement.word);
      double farthest = 0, sum = 0;
      const auto moved = chosen.units.moved[placement.unit];
      for (const std::uint32_t point : moved) {
        const double move = (embedding.positions[point] - ball.mesh.positions[point]).norm();
        farthest = std::max(farthest, move);
        sum += move * move;
      }
      const double rms = std::sqrt(sum / static_cast<double>(moved.size()));
      const double actual = cost == CostFunction::Displacement ? farthest : rms;
      EXPECT_NEAR(actual, expected, cost_precision_ * actual + 1e-9);
    }
  }
}

// The surface moves at most as far as its points, and where no point moves nothing changes.
TEST_P(EveryScheme, HausdorffCostIsAtMostTheFarthestMove) {
  const auto& ball = test::bumpy_ball();
  const auto words = words_of(code_, 16);
  const auto matrix = [&](CostFunction function) {
    const auto scheme = this->scheme(function);
    const auto bound = scheme->bind(ball.surface());
    const Chosen chosen = choose(*bound, ball.surface());
    return bound->costs(chosen.units, chosen.valid, words).values;
  };
  const auto farthest = matrix(CostFunction::Displacement);
  const auto hausdorff = matrix(CostFunction::Hausdorff);
  const auto normal = matrix(CostFunction::Normal);
  ASSERT_EQ(hausdorff.size(), farthest.size());
  std::size_t below = 0;
  for (std::size_t i = 0; i < farthest.size(); ++i) {
    EXPECT_EQ(hausdorff[i] == kInfeasible, farthest[i] == kInfeasible);
    EXPECT_EQ(normal[i] == kInfeasible, farthest[i] == kInfeasible);
    if (farthest[i] == kInfeasible) continue;
    EXPECT_GE(hausdorff[i], 0);
    EXPECT_LE(hausdorff[i], farthest[i] * 1.001F);
    EXPECT_GT(normal[i], 0);
    below += hausdorff[i] < 0.99F * farthest[i] ? 1 : 0;
  }
  // iie moves along the normal, where nothing is free
  EXPECT_GT(below, is_iie() ? 0 : farthest.size() / 10);
}

TEST_P(EveryScheme, ReadsTheSameUnderAnySimilarityAndOrder) {
  const auto& ball = test::bumpy_ball();
  const auto scheme = relative_scheme();
  const auto bound = scheme->bind(ball.surface());
  const Chosen chosen = choose(*bound, ball.surface());
  const auto words = words_of(code_, 256);
  const Embedding embedding =
      bound->embed(chosen.units, random_placements(*bound, chosen, words), words);
  const auto good_words = [&](const Mesh& mesh) {
    std::multiset<std::pair<std::uint32_t, std::uint32_t>> found;
    const test::Solid solid(mesh);
    for (const Reading& reading : scheme->bind(solid.surface())->read()) {
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

TEST_P(EveryScheme, BoundariesAndTinyMeshesOfferNothing) {
  for (Mesh mesh : {test::tetrahedron(), test::flat_grid(1, 1), Mesh{}}) {
    const test::Solid solid(std::move(mesh));
    EXPECT_EQ(relative_scheme()->bind(solid.surface())->find_units().size(), 0U);
    EXPECT_TRUE(relative_scheme()->bind(solid.surface())->read().empty());
  }
}

TEST_P(EveryScheme, DegenerateTrianglesAreNeitherUnitsNorTrouble) {
  Mesh collapsed = test::flat_grid(6, 6);
  for (std::size_t i = 0; i < collapsed.positions.size(); i += 2) {
    collapsed.positions[i] = Vec3(1, 1, 0);
  }
  for (std::size_t i = 1; i < collapsed.positions.size(); i += 6) {
    collapsed.positions[i][0] += 1e-300;
  }
  Mesh line = test::flat_grid(6, 6);
  for (Vec3& p : line.positions) p = Vec3(p[0] + p[1], 0, 0);
  for (const Mesh& mesh : {collapsed, line}) {
    const test::Solid solid(mesh);
    const auto scheme = this->scheme();
    const auto bound = scheme->bind(solid.surface());
    const UnitSet units = bound->find_units();
    for (const Reading& reading : bound->read()) {
      EXPECT_TRUE(std::isfinite(reading.weight));
    }
    std::vector<std::uint32_t> all(units.size());
    std::iota(all.begin(), all.end(), 0U);
    const auto words = words_of(code_, 4);
    for (const float cost : bound->costs(units, all, words).values) {
      EXPECT_FALSE(std::isnan(cost));
    }
  }
}

TEST_P(EveryScheme, ResultsDoNotDependOnThreads) {
  const auto& ball = test::bumpy_ball();
  const auto words = words_of(code_, 100);
  const auto scheme = this->scheme();
  test::expect_same_for_any_threads([&] {
    const auto bound = scheme->bind(ball.surface());
    const Chosen chosen = choose(*bound, ball.surface());
    const auto costs = bound->costs(chosen.units, chosen.valid, words);
    const auto embedding =
        bound->embed(chosen.units, random_placements(*bound, chosen, words), words);
    return std::make_tuple(chosen.units.anchors, chosen.units.moved.points, costs.values,
                           embedding.positions, embedding.failed);
  });
}

bool same(std::span<const Reading> a, std::span<const Reading> b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Reading& x, const Reading& y) {
    return x.anchor == y.anchor && x.word == y.word && x.weight == y.weight &&
           x.worst_offset == y.worst_offset && x.bit_weights == y.bit_weights;
  });
}

// Of the ball's units, each with a word that it can carry.
Embedding embed_randomly(const BoundScheme& bound, const WordCode& code) {
  const Chosen chosen = choose(bound, test::bumpy_ball().surface());
  const auto words = words_of(code, 100);
  return bound.embed(chosen.units, random_placements(bound, chosen, words), words);
}

TEST_P(EveryScheme, MovedToReadsLikeAFreshBind) {
  const auto& ball = test::bumpy_ball();
  for (const bool is_relative : {false, true}) {
    const auto scheme = is_relative ? relative_scheme() : this->scheme();
    const auto bound = scheme->bind(ball.surface());
    const Mesh marked{embed_randomly(*bound, code_).positions, ball.mesh.triangles};
    const auto fresh = scheme->bind({marked, ball.halfedges});
    const auto moved = bound->moved_to({marked, ball.halfedges});
    EXPECT_FALSE(fresh->read().empty());
    EXPECT_TRUE(same(moved->read(), fresh->read()));
    EXPECT_EQ(moved->cell_size(), fresh->cell_size());
    const UnitSet units = fresh->find_units();
    EXPECT_EQ(moved->find_units().anchors, units.anchors);
    EXPECT_EQ(moved->points_of(units.anchors).points, fresh->points_of(units.anchors).points);
    EXPECT_TRUE(same(moved->moved_to(ball.surface())->read(), bound->read()));
  }
}

// Every third reading, each candidate that shows nothing, and anchors that the surface lacks.
TEST_P(EveryScheme, ReadAtFindsWhatReadFindsThere) {
  for (const SampleShape shape : {SampleShape::Closed, SampleShape::Open, SampleShape::HighGenus}) {
    const test::Solid solid(make_sample_shape(shape, 5000, 3));
    const auto scheme = relative_scheme();
    const auto bound = scheme->bind(solid.surface());
    const Chosen chosen = choose(*bound, solid.surface());
    const auto words = words_of(code_, 100);
    const auto placements = random_placements(*bound, chosen, words);
    const Mesh marked{bound->embed(chosen.units, placements, words).positions,
                      solid.mesh.triangles};
    const auto moved = bound->moved_to({marked, solid.halfedges});
    const std::vector<Reading> all = moved->read();
    ASSERT_GT(all.size(), 30U);
    std::set<std::uint32_t> silent(chosen.units.anchors.begin(), chosen.units.anchors.end());
    for (const Reading& reading : all) silent.erase(reading.anchor);
    std::set<std::uint32_t> anchors = silent;
    std::vector<Reading> expected;
    for (std::size_t i = 0; i < all.size(); i += 3) {
      anchors.insert(all[i].anchor);
      expected.push_back(all[i]);
    }
    anchors.insert({0xfffffff0, 0xffffffff});
    EXPECT_TRUE(same(moved->read_at(std::vector(anchors.begin(), anchors.end())), expected));
    EXPECT_TRUE(moved->read_at({}).empty());
  }
}

TEST_P(EveryScheme, ASampleHoldsSomeOfTheReadings) {
  const auto embedding = scheme();
  const auto bound = embedding->bind(test::bumpy_ball().surface());
  const auto sample = bound->read_sample(4);
  if (!sample) GTEST_SKIP() << "it is read as a whole";
  const std::vector<Reading> all = bound->read();
  const auto precedes = [](const Reading& a, const Reading& b) { return a.anchor < b.anchor; };
  EXPECT_TRUE(std::includes(all.begin(), all.end(), sample->begin(), sample->end(), precedes));
  EXPECT_NEAR(static_cast<double>(sample->size()), static_cast<double>(all.size()) / 4,
              0.1 * static_cast<double>(all.size()));
  EXPECT_EQ(bound->read_sample(1)->size(), all.size());
}

TEST_P(EveryScheme, CallsCanBeRepeated) {
  const auto& ball = test::bumpy_ball();
  const auto scheme = relative_scheme();
  const auto bound = scheme->bind(ball.surface());
  const auto words = words_of(code_, 100);
  const Chosen chosen = choose(*bound, ball.surface());
  const auto placements = random_placements(*bound, chosen, words);
  const Embedding first = bound->embed(chosen.units, placements, words);
  const CostMatrix costs = bound->costs(chosen.units, chosen.valid, words);
  const auto readings = bound->read();
  EXPECT_EQ(bound->find_units().anchors, chosen.units.anchors);
  EXPECT_EQ(bound->find_units().moved.points, chosen.units.moved.points);
  // of a few units, so that embed no longer finds the others among those asked about last
  (void)bound->costs(chosen.units, std::span(chosen.valid).first(chosen.valid.size() / 2), words);
  EXPECT_EQ(bound->embed(chosen.units, placements, words).positions, first.positions);
  EXPECT_EQ(bound->costs(chosen.units, chosen.valid, words).values, costs.values);
  EXPECT_EQ(bound->embed(chosen.units, placements, words).positions, first.positions);
  EXPECT_TRUE(same(bound->read(), readings));
}

TEST_P(EveryScheme, RefusesCellsWithoutWidth) {
  for (const double step : {0.0, -1.0, 10.0, std::nan("")}) {
    EXPECT_THROW((void)make_scheme(name(), code_, {{"step", step}}), Error) << step;
  }
}

TEST(Schemes, HaveNames) {
  EXPECT_THROW((void)scheme_info("xyz"), Error);
}

// What applies is written down whole, so that a record says all that a reader needs.
TEST_P(EveryScheme, DefaultsNameEveryOption) {
  for (const bool fill : {false, true}) {
    const OptionValues values = scheme_info(name()).defaults(fill, Strength::Normal).options;
    EXPECT_EQ(values.size(), scheme_info(name()).options.size());
    for (const OptionSpec& spec : scheme_info(name()).options) {
      ASSERT_TRUE(values.contains(spec.key)) << spec.key;
      EXPECT_EQ(spec.checked(values.at(spec.key)), values.at(spec.key)) << spec.key;
    }
  }
}

}  // namespace
}  // namespace triglyph
