#include "engine/scheme/iie/iie.h"

#include <set>

#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "engine/marking/extract.h"
#include "engine/marking/mark.h"
#include "engine/marking/settle.h"
#include "engine/mesh/edge_length.h"
#include "engine/scheme/iie/ring_signature.h"
#include "engine/scheme/registry.h"
#include "tests/support/arenas.h"
#include "tests/support/attacks.h"
#include "tests/support/shapes.h"

namespace triglyph {
namespace {

const Message kBallsMessage{'b', 'a', 'l', 'l', 's', ' ', '8', '!'};

// On a mesh of its own, large enough for the message to come back after noise.
struct Marked {
  MarkOptions options = default_mark_options("iie", false);
  WordCode code{Key::trial(), options.format};
  std::unique_ptr<Scheme> scheme = make_scheme("iie", code, options.scheme_options);
  test::Solid original{make_sample_shape(SampleShape::Closed, 100000, 11)};
  Marking marking =
      mark(original.surface(), kBallsMessage, Key::trial(), options, test::as_float, 1e-7);
  Mesh mesh{marking.positions, original.mesh.triangles};

  [[nodiscard]] Extraction read(const Mesh& other) const {
    const test::Solid solid(other);
    return extract(solid.surface(), options.encoding(), Key::trial());
  }
};

const Marked& marked() {
  static const Marked marked;
  return marked;
}

TEST(Iie, MessageSurvivesNoiseQuantisationMotionAndOrder) {
  ASSERT_EQ(marked().marking.status, MarkStatus::Marked);
  EXPECT_EQ(marked().read(marked().mesh).message, kBallsMessage);
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    EXPECT_EQ(marked().read(test::with_uniform_noise(marked().mesh, 0.0005, seed)).message,
              kBallsMessage);
    EXPECT_EQ(marked().read(test::shuffled(marked().mesh, seed)).message, kBallsMessage);
    EXPECT_EQ(marked().read(test::moved_rigidly_and_scaled(marked().mesh, seed)).message,
              kBallsMessage);
  }
  EXPECT_EQ(marked().read(test::quantised(marked().mesh, 11)).message, kBallsMessage);
  EXPECT_FALSE(marked().read(marked().original.mesh).message);
}

TEST(Iie, DamageIsLocal) {
  Mesh dented = marked().mesh;
  std::size_t touched = 0;
  for (Vec3& p : dented.positions) {
    if (p[0] < 0.8 * p.norm()) continue;
    p *= 1 + 0.02 * std::sin(40 * p[1]);
    ++touched;
  }
  EXPECT_GT(touched, dented.positions.size() / 50);
  const Extraction found = marked().read(dented);
  std::set<std::uint32_t> readable;
  for (const Reading& reading : found.readings) {
    for (const Carrier& carrier : marked().marking.carriers) {
      if (carrier.anchor == reading.anchor &&
          marked().marking.words[carrier.word] == reading.word) {
        readable.insert(reading.anchor);
      }
    }
  }
  std::size_t lost_inside = 0, inside = 0, lost_outside = 0, outside = 0;
  for (const Carrier& carrier : marked().marking.carriers) {
    const Vec3& p = marked().mesh.positions[carrier.anchor];
    const bool lost = readable.count(carrier.anchor) == 0;
    if (p[0] > 0.8 * p.norm()) {
      ++inside;
      lost_inside += lost ? 1 : 0;
    } else if (p[0] < 0.7 * p.norm()) {
      ++outside;
      lost_outside += lost ? 1 : 0;
    }
  }
  EXPECT_GT(inside, 3U);
  EXPECT_GT(outside, 50U);
  EXPECT_GE(lost_inside * 2, inside);
  EXPECT_LE(lost_outside * 10, outside);
}

TEST(Iie, MovesOnlyWhatNoOtherUnitReads) {
  const auto& ball = test::bumpy_ball();
  const IieScheme scheme(WordCode(Key::trial(), IieOptions::format(true)),
                         IieOptions::defaults(true));
  const UnitSet units = scheme.bind(ball.surface())->find_units();
  const auto valid = choose_layout(Conflicts(units.moved, units.read_or_moved(),
                                             ball.mesh.positions.size(), ConflictRule::ReadWrite),
                                   {});
  EXPECT_GT(valid.size(), 50U);
  std::set<std::uint32_t> moved;
  for (const std::uint32_t unit : valid) {
    for (const std::uint32_t point : units.moved[unit]) EXPECT_TRUE(moved.insert(point).second);
    EXPECT_GT(units.read[unit].size(), units.moved[unit].size());
  }
}

TEST(Iie, FillIsReadBackAndOptimisationPays) {
  MarkOptions optimised = default_mark_options("iie", true);
  optimised.scheme_options = fixed_for(test::bumpy_ball().mesh, optimised.scheme_options);
  MarkOptions plain = optimised;
  plain.layout.method = LayoutMethod::FirstFit;
  plain.assign = AssignMethod::Sequential;
  const auto fill = [](const MarkOptions& options) {
    return mark(test::bumpy_ball().surface(), Fill{}, Key::trial(), options, test::as_float, 1e-7);
  };
  const Marking before = fill(plain);
  const Marking after = fill(optimised);
  EXPECT_LT(after.cost_max, 0.7 * before.cost_max);
  EXPECT_GT(after.units_valid, before.units_valid);
  EXPECT_GE(after.carriers.size(), after.units_valid * 95 / 100);
}

TEST(Iie, RefusesWhatCannotBe) {
  const auto refuses = [](const WordFormat& format, const IieOptions& options) {
    EXPECT_THROW(IieScheme(WordCode(Key::trial(), format), options), Error);
  };
  refuses({8, 9, 4}, {});
  refuses({1, 5, 17}, {});
  const auto with = [](const auto& change) {
    IieOptions options;
    change(options);
    return options;
  };
  refuses({1, 5, 4}, with([](IieOptions& options) { options.radius_edges = 1; }));
  refuses({1, 5, 4}, with([](IieOptions& options) { options.radius = -1; }));
  refuses({1, 5, 4}, with([](IieOptions& options) { options.centre_rings = 0; }));
  refuses({1, 5, 4}, with([](IieOptions& options) { options.site_rings = 9; }));
}

TEST(RingSignatures, DependOnConnectivityAloneAndTellPointsApart) {
  const Mesh& mesh = test::bumpy_ball().mesh;
  const auto signatures_of = [](const Mesh& m, std::uint64_t seed) {
    auto found = ring_signatures(build_halfedges(m), m.positions.size(), seed);
    std::sort(found.begin(), found.end());
    return found;
  };
  const auto expected = signatures_of(mesh, 1);
  EXPECT_EQ(signatures_of(test::shuffled(mesh, 3), 1), expected);
  EXPECT_EQ(signatures_of(test::with_uniform_noise(mesh, 0.01, 3), 1), expected);
  EXPECT_NE(signatures_of(mesh, 2), expected);
  const std::set<std::uint64_t> distinct(expected.begin(), expected.end());
  EXPECT_GT(distinct.size(), expected.size() / 2);
}

TEST(RingSignatures, OfARegularGridAreAllTheSameAndNoneAtItsBorder) {
  const Mesh grid = test::flat_grid(9, 9);
  const auto signatures = ring_signatures(build_halfedges(grid), grid.positions.size(), 1);
  const std::set<std::uint64_t> distinct(signatures.begin(), signatures.end());
  EXPECT_EQ(distinct.size(), 2U);
  EXPECT_EQ(signatures[0], 0U);
  EXPECT_EQ(signatures[22], 0U);  // two rings from the border are not complete
  EXPECT_NE(signatures[44], 0U);
}

}  // namespace
}  // namespace triglyph
