#include "engine/marking/mark.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <set>
#include <thread>

#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "engine/base/stop.h"
#include "engine/marking/extract.h"
#include "engine/marking/plan_words.h"
#include "engine/marking/settle.h"
#include "engine/mesh/surface_diagonal.h"
#include "engine/scheme/registry.h"
#include "tests/support/arenas.h"
#include "tests/support/attacks.h"
#include "tests/support/shapes.h"

namespace triglyph {
namespace {

const Message kMessage{'o', 'w', 'n', 'e', 'r', ' ', '4', '2'};

Vec3 unrounded(const Vec3& p) {
  return p;
}

const test::Solid& ball_for(const MarkOptions& options) {
  return options.scheme == "iie" ? test::large_ball() : test::bumpy_ball();
}

Marking mark_ball(const MarkOptions& options = {}) {
  return mark(ball_for(options).surface(), kMessage, Key::trial(), options, test::as_float, 1e-7);
}

Mesh marked_ball(const MarkOptions& options = {}) {
  return {mark_ball(options).positions, ball_for(options).mesh.triangles};
}

Extraction read(const Mesh& mesh, const Key& key = Key::trial(), const MarkOptions& options = {}) {
  const test::Solid solid(mesh);
  return extract(solid.surface(), options.encoding(), key);
}

TEST(Mark, MessageComesBackAndEveryCarrierAgrees) {
  const Marking marking = mark_ball();
  EXPECT_EQ(marking.status, MarkStatus::Marked);
  EXPECT_EQ(marking.carriers.size() + marking.units_dropped, marking.units_assigned);
  const Extraction found = read({marking.positions, test::bumpy_ball().mesh.triangles});
  EXPECT_EQ(found.message, kMessage);
  EXPECT_GE(found.agreeing, marking.carriers.size());
  EXPECT_EQ(found.parts, marking.parts_needed);
  EXPECT_GT(marking.words.size(), found.parts);
  EXPECT_GT(found.agreement, 0.8);
}

TEST(Mark, MessagesOfOneTo256BytesComeBack) {
  for (const std::size_t bytes : {1, 2, 16, 64, 256}) {
    Message message(bytes);
    for (std::size_t i = 0; i < bytes; ++i) message[i] = static_cast<std::uint8_t>(37 * i + bytes);
    const Marking marking =
        mark(test::bumpy_ball().surface(), message, Key::trial(), {}, test::as_float, 1e-7);
    EXPECT_EQ(read({marking.positions, test::bumpy_ball().mesh.triangles}).message, message);
  }
}

TEST(Mark, SurvivesReorderingSimilarityRoundingAndCropping) {
  const Mesh marked = marked_ball();
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    EXPECT_EQ(read(test::shuffled(marked, seed)).message, kMessage) << seed;
    EXPECT_EQ(read(test::moved_rigidly_and_scaled(marked, seed)).message, kMessage) << seed;
    EXPECT_EQ(read(test::cropped_half(marked, seed)).message, kMessage) << seed;
  }
  EXPECT_EQ(read(test::with_significant_digits(marked, 6)).message, kMessage);
  EXPECT_EQ(read(test::with_significant_digits(test::cropped_half(test::shuffled(marked, 1), 2), 6))
                .message,
            kMessage);
}

class EverySchemesMark : public testing::TestWithParam<std::string_view> {
 protected:
  MarkOptions options_ = default_mark_options(std::string(GetParam()), false);
};
INSTANTIATE_TEST_SUITE_P(All, EverySchemesMark,
                         testing::ValuesIn(scheme_names().begin(), scheme_names().end()),
                         [](const auto& scheme) { return std::string(scheme.param); });

TEST_P(EverySchemesMark, AnotherKeyAndAnUnmarkedMeshYieldNothing) {
  const Mesh marked = marked_ball(options_);
  EXPECT_EQ(read(marked, Key::trial(), options_).message, kMessage);
  for (int i = 0; i < 20; ++i) EXPECT_FALSE(read(marked, Key::generate(), options_).message);
  EXPECT_FALSE(read(ball_for(options_).mesh, Key::trial(), options_).message);
}

TEST_P(EverySchemesMark, IsReadFromTheSurfaceTurnedInsideOutAndFromItsMirrorImage) {
  const Mesh marked = marked_ball(options_);
  const double one_attempt = read(marked, Key::trial(), options_).false_alarm;
  const Mesh turned = test::turned_inside_out(marked);
  for (const Mesh& other : {turned, test::mirrored(marked), test::mirrored(turned)}) {
    const Extraction found = read(test::shuffled(other, 1), Key::trial(), options_);
    EXPECT_EQ(found.message, kMessage);
    EXPECT_EQ(found.agreeing, read(marked, Key::trial(), options_).agreeing);
  }
  // what was tried is paid for
  EXPECT_GE(read(turned, Key::trial(), options_).false_alarm, 2 * one_attempt);
  EXPECT_GE(read(marked, Key::generate(), options_).false_alarm, 2 * one_attempt);
}

TEST_P(EverySchemesMark, AMarkedMeshIsMarkedAgainOnlyIfThatIsWanted) {
  const test::Solid once(marked_ball(options_));
  const auto mark_again = [&](const Key& key) {
    return mark(once.surface(), Message{'b'}, key, options_, test::as_float, 1e-7);
  };
  const Marking refused = mark_again(Key::trial());
  EXPECT_EQ(refused.status, MarkStatus::AlreadyMarked);
  ASSERT_TRUE(refused.found);
  EXPECT_EQ(refused.found->message, kMessage);
  EXPECT_GT(refused.found->agreeing, 0U);
  EXPECT_EQ(mark_again(Key::generate()).status, MarkStatus::Marked);
  options_.remark = true;
  const Marking again = mark_again(Key::trial());
  ASSERT_EQ(again.status, MarkStatus::Marked);
  EXPECT_EQ(read({again.positions, once.mesh.triangles}, Key::trial(), options_).message,
            Message{'b'});
}

// A sample of a mesh that carries a message looks marked; of others one in a hundred does.
TEST_P(EverySchemesMark, SamplesOfMarkedMeshesRepeatWords) {
  const auto looks_marked = [&](const Mesh& mesh) -> std::optional<bool> {
    const test::Solid solid(mesh);
    const WordCode code(Key::trial(), options_.format);
    const auto scheme = make_scheme(options_.scheme, code, options_.scheme_options);
    const auto sample = scheme->bind(solid.surface())->read_sample(6);
    if (!sample) return std::nullopt;
    return has_repeated_words(*sample, options_.format);
  };
  if (!looks_marked(ball_for(options_).mesh)) GTEST_SKIP() << "it is read as a whole";
  EXPECT_EQ(looks_marked(marked_ball(options_)), true);
  EXPECT_EQ(looks_marked(test::cropped_half(marked_ball(options_), 1)), true);
  int alarms = 0;
  for (std::uint64_t i = 0; i < 60; ++i) {
    alarms += *looks_marked(make_sample_shape(SampleShape::Closed, 1000 + 500 * i, i)) ? 1 : 0;
  }
  EXPECT_LE(alarms, 4);
}

TEST_P(EverySchemesMark, FillIsNotAskedForAMark) {
  const test::Solid once(marked_ball(options_));
  EXPECT_EQ(mark(once.surface(), Fill{}, Key::trial(), default_mark_options(options_.scheme, true),
                 test::as_float, 1e-7)
                .status,
            MarkStatus::Marked);
}

// 200 unmarked meshes: no false alarm. With a 32-bit tag one is expected in 20 million such runs.
TEST_P(EverySchemesMark, TwoHundredUnmarkedMeshesRaiseNoAlarm) {
  const SampleShape shapes[] = {SampleShape::Closed, SampleShape::Open, SampleShape::HighGenus};
  std::size_t markers = 0;
  for (std::uint64_t i = 0; i < 200; ++i) {
    const Extraction found =
        read(make_sample_shape(shapes[i % 3], 1000 + 20 * i, i), Key::trial(), options_);
    EXPECT_FALSE(found.message);
    markers += found.readings.size();
  }
  EXPECT_GT(markers, 200U);  // chance look-alikes there are, so the tag has something to refuse
}

// A ball folded into itself, one inside out, one with collapsed faces, one of needles.
std::vector<Mesh> hostile_meshes(const Mesh& ball) {
  Mesh crossing = ball;
  for (Vec3& p : crossing.positions) p[0] = std::abs(p[0]) - 0.3 * p[0] * p[0];
  Mesh inside_out = ball;
  for (Triangle& triangle : inside_out.triangles) std::swap(triangle[0], triangle[1]);
  Mesh collapsed = ball;
  for (std::size_t t = 0; t < ball.triangles.size(); t += 7) {
    const Triangle& triangle = ball.triangles[t];
    collapsed.positions[triangle[0]] = collapsed.positions[triangle[1]];
  }
  Mesh needles = ball;
  for (std::size_t i = 0; i < needles.positions.size(); i += 3) needles.positions[i] *= 1e-9;
  return {crossing, inside_out, collapsed, needles};
}

TEST_P(EverySchemesMark, HostileMeshesAreMarkedOrRefusedButNeverSpoilt) {
  for (const Mesh& mesh : hostile_meshes(ball_for(options_).mesh)) {
    const test::Solid solid(mesh);
    const Marking marking =
        mark(solid.surface(), kMessage, Key::trial(), options_, test::as_float, 1e-7);
    for (const Vec3& p : marking.positions) {
      EXPECT_TRUE(std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]));
    }
    EXPECT_TRUE(flipped_triangles(mesh.triangles, mesh.positions, marking.positions).empty());
    if (marking.status == MarkStatus::Marked) {
      EXPECT_EQ(read({marking.positions, mesh.triangles}, Key::trial(), options_).message,
                kMessage);
    } else {
      EXPECT_TRUE(marking.status == MarkStatus::TooSmall ||
                  marking.status == MarkStatus::TooCoarse);
    }
  }
}

TEST_P(EverySchemesMark, InsideOutIsNoObstacle) {
  const Mesh mesh = hostile_meshes(ball_for(options_).mesh)[1];
  const test::Solid solid(mesh);
  const Marking marking =
      mark(solid.surface(), kMessage, Key::trial(), options_, test::as_float, 1e-7);
  ASSERT_EQ(marking.status, MarkStatus::Marked);
  EXPECT_EQ(read({marking.positions, mesh.triangles}, Key::trial(), options_).message, kMessage);
}

TEST_P(EverySchemesMark, SheetsThatAreAllBoundaryAreTooSmall) {
  Mesh soup;
  for (std::uint32_t i = 0; i < 300; i += 3) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      soup.positions.emplace_back(i + (k == 1 ? 1 : 0), k == 2 ? 1 : 0, 0.1 * i);
    }
    soup.triangles.push_back({i, i + 1, i + 2});
  }
  const test::Solid solid(soup);
  EXPECT_EQ(mark(solid.surface(), kMessage, Key::trial(), options_, unrounded, 0).status,
            MarkStatus::TooSmall);
}

TEST(Mark, UnitsAreDisjointAndOnlyTheirPointsMove) {
  const auto& ball = test::bumpy_ball();
  const Marking marking = mark_ball();
  std::size_t moved = 0;
  for (std::size_t i = 0; i < marking.positions.size(); ++i) {
    moved += marking.positions[i] != ball.mesh.positions[i] ? 1 : 0;
  }
  EXPECT_LE(moved, 6 * marking.carriers.size());
  EXPECT_GT(moved, 3 * marking.carriers.size());
  EXPECT_TRUE(
      flipped_triangles(ball.mesh.triangles, ball.mesh.positions, marking.positions).empty());
}

TEST(Mark, OptimisedMovesLessThanUnoptimised) {
  MarkOptions plain;
  plain.layout.method = LayoutMethod::FirstFit;
  plain.assign = AssignMethod::Sequential;
  MarkOptions max;  // both with all repeats, so that they solve the same problem
  max.max_move_percent = 0;
  MarkOptions sum = max;
  sum.assign = AssignMethod::Sum;
  const Marking unoptimised = mark_ball(plain);
  const Marking bottleneck = mark_ball(max);
  const Marking least_sum = mark_ball(sum);
  EXPECT_LT(bottleneck.cost_max, 0.5 * unoptimised.cost_max);
  EXPECT_LE(bottleneck.cost_max, least_sum.cost_max);
  EXPECT_LE(least_sum.cost_sum, bottleneck.cost_sum);
  EXPECT_GT(bottleneck.units_valid, unoptimised.units_valid);
  EXPECT_LE(bottleneck.units_valid, bottleneck.units_bound);
}

// The farthest move of a point, in percent of the diagonal.
double farthest_move(const Mesh& mesh, const Marking& marking) {
  double farthest = 0;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    farthest = std::max(farthest, (marking.positions[i] - mesh.positions[i]).norm());
  }
  return 100 * farthest / surface_diagonal(mesh);
}

// Coarse numbers move points beyond what the assignment knows of.
Vec3 with_three_decimals(const Vec3& p) {
  return Vec3(std::round(p[0] * 1e3), std::round(p[1] * 1e3), std::round(p[2] * 1e3)) / 1e3;
}

TEST_P(EverySchemesMark, NoPointMovesFartherThanTheLimit) {
  const test::Solid& ball = ball_for(options_);
  for (const CostFunction cost : {CostFunction::Displacement, CostFunction::Normal}) {
    for (const double percent : {1.0, 0.3, 0.1, 0.05}) {
      options_.cost = cost;
      options_.max_move_percent = percent;
      const Marking marking =
          mark(ball.surface(), kMessage, Key::trial(), options_, test::as_float, 1e-7);
      EXPECT_LE(farthest_move(ball.mesh, marking), percent);
      if (marking.status != MarkStatus::Marked) {
        EXPECT_EQ(marking.status, MarkStatus::TooVisible) << percent;
        continue;
      }
      EXPECT_EQ(read({marking.positions, ball.mesh.triangles}, Key::trial(), options_).message,
                kMessage);
    }
  }
}

TEST(Mark, NoPointMovesFartherThanTheLimitAfterRounding) {
  MarkOptions options;
  options.max_move_percent = 0.06;
  const Marking marking = mark(test::bumpy_ball().surface(), kMessage, Key::trial(), options,
                               with_three_decimals, 1e-3);
  EXPECT_LE(farthest_move(test::bumpy_ball().mesh, marking), 0.06);
}

// Small meshes of all shapes, and limits so low that none can be marked.
TEST_P(EverySchemesMark, TheLeastLimitThatIsNamedDoesAndATenthLessDoesNot) {
  const SampleShape shapes[] = {SampleShape::Closed, SampleShape::Open, SampleShape::HighGenus};
  const Message message{'m'};
  int refused = 0;
  if (options_.format.is_spread) GTEST_SKIP() << "no part is needed, so none needs a move";
  for (std::uint64_t i = 0; i < 6; ++i) {
    const std::size_t triangles = options_.scheme == "iie" ? 20'000 : 1000;
    const test::Solid solid(make_sample_shape(shapes[i % 3], triangles, i));
    const auto mark_within = [&](double percent) {
      options_.max_move_percent = percent;
      return mark(solid.surface(), message, Key::trial(), options_, test::as_float, 1e-7);
    };
    const Marking refusal = mark_within(1e-3);
    if (refusal.status == MarkStatus::TooSmall) continue;
    ASSERT_EQ(refusal.status, MarkStatus::TooVisible);
    ++refused;
    const WayOut& way_out = refusal.way_out;
    EXPECT_GE(way_out.max_move_percent, way_out.move_needed_percent);
    const Marking marked = mark_within(way_out.max_move_percent);
    EXPECT_EQ(marked.status, MarkStatus::Marked) << way_out.max_move_percent;
    EXPECT_LE(farthest_move(solid.mesh, marked), way_out.max_move_percent);
    EXPECT_EQ(mark_within(0.9 * way_out.move_needed_percent).status, MarkStatus::TooVisible);
  }
  EXPECT_GT(refused, 3);
}

TEST(Mark, FillAndSequentialAssignmentLeaveOutWhatMovesTooFar) {
  const test::Solid& ball = test::bumpy_ball();
  MarkOptions options = default_mark_options("tsq", true);
  const auto fill = [&] {
    return mark(ball.surface(), Fill{}, Key::trial(), options, test::as_float, 1e-7);
  };
  for (const AssignMethod assign : {AssignMethod::Bottleneck, AssignMethod::Sequential}) {
    options.assign = assign;
    options.max_move_percent.reset();
    const Marking all = fill();
    const double percent = 0.3 * farthest_move(ball.mesh, all);
    options.max_move_percent = percent;
    const Marking some = fill();
    EXPECT_EQ(some.status, MarkStatus::Marked);
    EXPECT_LE(farthest_move(ball.mesh, some), percent);
    EXPECT_LT(some.carriers.size(), all.carriers.size());
    EXPECT_GT(some.carriers.size(), all.carriers.size() / 10);
  }
  options.max_move_percent = 1e-9;
  EXPECT_EQ(fill().status, MarkStatus::TooVisible);
}

// A point far away that no face uses must not make moves look small.
TEST(Mark, LimitsRelateToWhatFacesUse) {
  Mesh mesh = test::bumpy_ball().mesh;
  MarkOptions options;
  options.max_move_percent = 0.05;
  const auto marked = [&] {
    const test::Solid solid(mesh);
    return mark(solid.surface(), kMessage, Key::trial(), options, test::as_float, 1e-7);
  };
  const Marking without = marked();
  mesh.positions.emplace_back(1000, 0, 0);
  EXPECT_EQ(marked().carriers, without.carriers);
}

TEST(Mark, RedundancyLeavesTheDearestUnitsOut) {
  MarkOptions few;
  few.redundancy = 4;
  MarkOptions all;
  all.redundancy = 0;
  const Marking sparse = mark_ball(few);
  const Marking full = mark_ball(all);
  EXPECT_EQ(sparse.units_assigned, 4 * sparse.words.size());
  EXPECT_GT(full.units_assigned, full.units_valid * 9 / 10);
  EXPECT_LT(sparse.cost_max, full.cost_max);
}

TEST(Mark, FillGivesEveryUnitAPartOfItsOwn) {
  const MarkOptions options = default_mark_options("tsq", true);
  const auto& ball = test::bumpy_ball();
  const Marking marking = mark(ball.surface(), Fill{}, Key::trial(), options, test::as_float, 1e-7);
  EXPECT_EQ(marking.words.size(), marking.units_valid);
  EXPECT_GE(marking.carriers.size(), marking.units_valid * 95 / 100);
  std::set<std::uint32_t> words;
  for (const Carrier& carrier : marking.carriers) words.insert(carrier.word);
  EXPECT_EQ(words.size(), marking.carriers.size());
}

TEST(Mark, RefusesAnEmptyMessageInsteadOfFilling) {
  const auto refuses = [](const Payload& payload) {
    try {
      (void)mark(test::bumpy_ball().surface(), payload, Key::trial(), {}, test::as_float, 1e-7);
    } catch (const Error& error) {
      return error.code() == ErrorCode::Usage;
    }
    return false;
  };
  EXPECT_TRUE(refuses(Message{}));
  EXPECT_TRUE(refuses({}));  // nothing chosen is no choice of fill
  EXPECT_TRUE(refuses(Message(257)));
}

TEST(Mark, TooSmallAndTooCoarseAreSaid) {
  const test::Solid grid(test::flat_grid(3, 3));
  EXPECT_EQ(mark(grid.surface(), kMessage, Key::trial(), {}, unrounded, 0).status,
            MarkStatus::TooSmall);
  const test::Solid tetrahedron(test::tetrahedron());
  EXPECT_EQ(mark(tetrahedron.surface(), Fill{}, Key::trial(), {}, unrounded, 0).status,
            MarkStatus::TooSmall);
  const double step = 0.01;  // about a third of an edge
  const auto coarse = [&](const Vec3& p) {
    return Vec3(std::round(p[0] / step), std::round(p[1] / step), std::round(p[2] / step)) * step;
  };
  EXPECT_EQ(mark(test::bumpy_ball().surface(), kMessage, Key::trial(), {}, coarse, step).status,
            MarkStatus::TooCoarse);
}

// Small meshes of all shapes, and a message that is far too long for them.
TEST_P(EverySchemesMark, TheShorterMessageThatIsNamedFits) {
  const SampleShape shapes[] = {SampleShape::Closed, SampleShape::Open, SampleShape::HighGenus};
  Message message(options_.format.is_spread ? kMaxSpreadBytes : 100);
  while (parts_for(options_.format, message.size()) > 1U << options_.format.subscript_bits) {
    message.pop_back();
  }
  for (std::size_t i = 0; i < message.size(); ++i) message[i] = static_cast<std::uint8_t>(37 * i);
  int shortened = 0;
  for (std::uint64_t i = 0; i < 9; ++i) {
    const std::size_t triangles = (options_.scheme == "iie" ? 5000 : 250) * (1 + i / 3);
    const test::Solid solid(make_sample_shape(shapes[i % 3], triangles, i));
    const auto mark_with = [&](std::size_t bytes) {
      const Message part(message.begin(), message.begin() + static_cast<std::ptrdiff_t>(bytes));
      return mark(solid.surface(), part, Key::trial(), options_, test::as_float, 1e-7);
    };
    const Marking refused = mark_with(message.size());
    ASSERT_EQ(refused.status, MarkStatus::TooSmall) << i;
    const std::size_t bytes = refused.way_out.message_bytes;
    if (bytes == 0) {
      EXPECT_EQ(mark_with(1).status, MarkStatus::TooSmall) << i;
      continue;
    }
    ++shortened;
    const Marking marked = mark_with(bytes);
    ASSERT_EQ(marked.status, MarkStatus::Marked) << i;
    const Message part(message.begin(), message.begin() + static_cast<std::ptrdiff_t>(bytes));
    EXPECT_EQ(read({marked.positions, solid.mesh.triangles}, Key::trial(), options_).message, part);
    EXPECT_EQ(mark_with(bytes + 1).status, MarkStatus::TooSmall) << i;
  }
  EXPECT_GT(shortened, 2);
}

TEST(Mark, TheWiderCellsThatAreNamedSurviveCoarseNumbers) {
  double step = 1e-5;
  const auto coarse = [&](const Vec3& p) {
    return Vec3(std::round(p[0] / step), std::round(p[1] / step), std::round(p[2] / step)) * step;
  };
  MarkOptions options;
  const auto mark_coarsely = [&] {
    return mark(test::bumpy_ball().surface(), kMessage, Key::trial(), options, coarse, step);
  };
  Marking refused = mark_coarsely();
  while (refused.status != MarkStatus::TooCoarse) {
    step *= 1.2;
    refused = mark_coarsely();
  }
  ASSERT_GT(refused.way_out.step, 0.02);
  options.scheme_options["step"] = refused.way_out.step;
  const Marking marked = mark_coarsely();
  ASSERT_EQ(marked.status, MarkStatus::Marked);
  EXPECT_EQ(
      read({marked.positions, test::bumpy_ball().mesh.triangles}, Key::trial(), options).message,
      kMessage);
}

// Moves ten times as far as usual are made only for those who allow them.
TEST(Mark, ALimitThatLetsMovesBeSeenIsNamedWhereTheUsualOneIsInTheWay) {
  const test::Solid solid(make_sample_shape(SampleShape::HighGenus, 250, 2));
  int named = 0;
  for (std::uint8_t c = 'a'; c <= 'z'; ++c) {
    MarkOptions options;
    const auto mark_small = [&] {
      return mark(solid.surface(), Message{c}, Key::trial(), options, test::as_float, 1e-7);
    };
    const Marking refused = mark_small();
    if (refused.status == MarkStatus::Marked) continue;
    if (refused.way_out.max_move_percent == 0) continue;
    ++named;
    EXPECT_GT(refused.way_out.max_move_percent, kUsualMove * kVisibleMove);
    options.max_move_percent = refused.way_out.max_move_percent;
    EXPECT_EQ(mark_small().status, MarkStatus::Marked);
  }
  EXPECT_GT(named, 0);
}

TEST(Mark, RefusesUnknownSchemesAndCellWidths) {
  MarkOptions options;
  options.scheme = "xyz";
  EXPECT_THROW((void)mark_ball(options), Error);
  options = {};
  options.scheme_options["step"] = 0.0;
  EXPECT_THROW((void)mark_ball(options), Error);
}

TEST(Mark, DoesNotDependOnThreads) {
  test::expect_same_for_any_threads([] {
    const Marking marking = mark_ball();
    return std::make_tuple(marking.positions, marking.carriers, marking.cost_sum);
  });
}

// Numbers so coarse that they spoil some units: these are taken back, and all that are left read
// their word. Sizes are fixed, since a unit that is taken back changes the mean edge length.
TEST_P(EverySchemesMark, EveryCarrierReadsItsWordWithMargin) {
  const test::Solid& ball = ball_for(options_);
  options_.scheme_options = fixed_for(ball.mesh, options_.scheme_options);
  Marking marking;
  for (double step = 2e-5; marking.units_dropped == 0; step *= 2) {
    ASSERT_LT(step, 0.01);
    const auto coarse = [&](const Vec3& p) {
      return Vec3(std::round(p[0] / step), std::round(p[1] / step), std::round(p[2] / step)) * step;
    };
    marking = mark(ball.surface(), kMessage, Key::trial(), options_, coarse, step);
  }
  ASSERT_GT(marking.carriers.size(), 20U);
  const Mesh marked{marking.positions, ball.mesh.triangles};
  const auto readings = read(marked, Key::trial(), options_).readings;
  for (const Carrier& carrier : marking.carriers) {
    const auto at = std::lower_bound(
        readings.begin(), readings.end(), carrier.anchor,
        [](const Reading& reading, std::uint32_t a) { return reading.anchor < a; });
    ASSERT_TRUE(at != readings.end() && at->anchor == carrier.anchor);
    EXPECT_EQ(at->word, marking.words[carrier.word]);
    EXPECT_LE(at->worst_offset, 0.5);
  }
}

// Filling this ball takes seconds; the flag is set before, and at moments of the layout, the costs
// and the assignment.
TEST(Mark, StopsSoonAfterTheFlagIsSet) {
  using namespace std::chrono_literals;
  using Clock = std::chrono::steady_clock;
  const test::Solid ball(make_sample_shape(SampleShape::Closed, 200'000, 1));
  MarkOptions options = default_mark_options("tsq", true);
  for (const auto delay : {0ms, 100ms, 500ms, 1500ms}) {
    std::atomic<bool> flag = false;
    const StopScope scope(flag);
    Clock::time_point set;
    std::thread interrupter([&] {
      std::this_thread::sleep_for(delay);
      set = Clock::now();
      flag = true;
    });
    EXPECT_THROW((void)mark(ball.surface(), Fill{}, Key::trial(), options, test::as_float, 1e-7),
                 Stopped)
        << delay.count();
    interrupter.join();
    EXPECT_LT(Clock::now() - set, 5s) << delay.count();
  }
}

TEST(Settle, TakesBackWhatFlipsAFace) {
  const Mesh sheet = test::flat_grid(4, 4);
  std::vector<Vec3> after = sheet.positions;
  after[12] += Vec3(1.5, 0.2, 0);
  EXPECT_FALSE(flipped_triangles(sheet.triangles, sheet.positions, after).empty());
  after = sheet.positions;
  after[12] += Vec3(0.2, 0.1, 0);
  EXPECT_TRUE(flipped_triangles(sheet.triangles, sheet.positions, after).empty());
}

}  // namespace
}  // namespace triglyph
