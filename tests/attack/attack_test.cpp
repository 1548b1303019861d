#include "engine/attack/attack.h"

#include <algorithm>
#include <set>
#include <string>

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include "engine/attack/coordinates.h"
#include "engine/attack/stored_mesh.h"
#include "engine/base/error.h"
#include "tests/support/shapes.h"

namespace triglyph {
namespace {

// Returns what the refusal says; empty if the text is accepted.
std::string refusal_of(const std::string& text) {
  try {
    (void)Attack::parsed(text);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::Usage);
    return error.what();
  }
  return "";
}

bool are_equal(const Mesh& a, const Mesh& b) {
  return a.positions == b.positions && a.triangles == b.triangles;
}

TEST(Attack, IsReadFromTextAndWrittenInItsShortestForm) {
  for (const char* text : {"none", "noise:0.3", "smooth:30", "simplify:97.5", "remesh", "midpoint",
                           "simplify:50+noise:0.1", "crop:10+reorder+digits:6"}) {
    EXPECT_EQ(Attack::parsed(text).text(), text);
  }
  EXPECT_EQ(Attack::parsed("noise:0.30").text(), "noise:0.3");
  EXPECT_EQ(Attack::parsed("remesh:100+loop:1").text(), "remesh+loop");
  EXPECT_EQ(Attack::parsed("loop:2").text(), "loop:2");
}

TEST(Attack, OfAWrongTextNamesTheStepAndSaysWhatIsAllowed) {
  const auto says = [](const std::string& text, const std::string& part) {
    const std::string refusal = refusal_of(text);
    EXPECT_NE(refusal.find(part), std::string::npos) << text << " -> " << refusal;
  };
  says("nois:0.3", "attack \"nois:0.3\"");
  says("nois:0.3", "did you mean noise?");
  says("quantize:9", "did you mean quantise?");
  says("bananas", "it is one of none, reorder");
  says("noise:0.3+simplfy:50", "attack \"simplfy:50\"");
  says("noise", "noise:N needs a number");
  says("noise:much", "0 to 100");
  says("noise:-1", "0 to 100");
  says("noise:nan", "0 to 100");
  says("noise:0.3x", "0 to 100");
  says("quantise:9.5", "a whole number, bits a coordinate, 1 to 24");
  says("simplify:100", "0 to 99.9");
  says("flip:2", "takes no number");
  says("flip:", "takes no number");
  says("noise:0.1++flip", "an empty name");
  says("", "an empty name");
}

// One attack of every kind, of a strength that leaves something.
std::vector<Attack> one_of_each_kind() {
  std::vector<Attack> attacks;
  for (const AttackKind& kind : attack_kinds()) {
    std::string text(kind.name);
    if (kind.name == "voxel") text += ":24";
    if (kind.name == "affine") text += ":2";
    if (kind.name == "simplify" || kind.name == "crop") text += ":50";
    const bool needs_number = kind.parameter && !kind.parameter->usual;
    if (needs_number && text == kind.name) text += ":6";
    attacks.push_back(Attack::parsed(text));
  }
  return attacks;
}

const Mesh& small_ball() {
  static const Mesh mesh = make_sample_shape(SampleShape::Closed, 2000, 7);
  return mesh;
}

TEST(Attack, DependsOnMeshAndSeedAlone) {
  const Mesh& mesh = small_ball();
  for (const Attack& attack : one_of_each_kind()) {
    SCOPED_TRACE(attack.text());
    const Mesh expected = attack.applied(mesh, 5);
    for (const int threads : {1, 3}) {
      tbb::task_arena arena(threads);
      EXPECT_TRUE(are_equal(arena.execute([&] { return attack.applied(mesh, 5); }), expected));
    }
    EXPECT_EQ(are_equal(attack.applied(mesh, 6), expected), !attack.draws_lots());
  }
}

// What is left must be a mesh that a file can hold and a reader can work on.
TEST(Attack, LeavesASoundMesh) {
  for (const Attack& attack : one_of_each_kind()) {
    SCOPED_TRACE(attack.text());
    const Mesh result = stored(attack.applied(small_ball(), 1));
    EXPECT_GT(result.triangles.size(), 300U);
    for (const Triangle& t : result.triangles) {
      ASSERT_LT(*std::max_element(t.begin(), t.end()), result.positions.size());
      ASSERT_TRUE(t[0] != t[1] && t[1] != t[2] && t[2] != t[0]);
    }
    EXPECT_TRUE(std::all_of(result.positions.begin(), result.positions.end(), [](const Vec3& p) {
      return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
    }));
  }
}

TEST(Attack, InARowDoesOneAfterTheOther) {
  const Mesh& mesh = test::bumpy_ball().mesh;
  const Mesh row = Attack::parsed("smooth:3+quantise:8").applied(mesh, 1);
  EXPECT_TRUE(are_equal(row, quantised(smoothed(mesh, 3), 8)));
  // the first step draws the same lots as it does alone, the second does not repeat them
  const Mesh once = Attack::parsed("noise:1").applied(mesh, 1);
  EXPECT_TRUE(are_equal(Attack::parsed("noise:1+none").applied(mesh, 1), once));
  const Mesh twice = Attack::parsed("noise:1+noise:1").applied(mesh, 1);
  const Vec3 first = once.positions[7] - mesh.positions[7];
  const Vec3 second = twice.positions[7] - once.positions[7];
  EXPECT_GT((first - second).norm(), 0.05 * first.norm());
}

TEST(Attack, KindsHaveNamesAndHelpOfTheirOwn) {
  std::set<std::string_view> names;
  for (const AttackKind& kind : attack_kinds()) {
    EXPECT_TRUE(names.insert(kind.name).second) << kind.name;
    EXPECT_FALSE(kind.help.empty()) << kind.name;
    EXPECT_EQ(kind.name.find_first_of(":+/ "), std::string_view::npos) << kind.name;
  }
}

TEST(Attack, CopesWithNothing) {
  for (const AttackKind& kind : attack_kinds()) {
    SCOPED_TRACE(kind.name);
    const double number = kind.parameter ? kind.parameter->usual.value_or(kind.parameter->most) : 0;
    EXPECT_TRUE(kind.apply({}, number, 1).triangles.empty());
    EXPECT_NO_THROW((void)kind.apply({{Vec3(1, 2, 3)}, {}}, number, 1));
  }
}

TEST(Protocol, OfAllIsThatOfTheBenchmarkAndThatOfLeaksWithoutRepeats) {
  std::set<std::string> all;
  for (const Attack& attack : protocol("all")) EXPECT_TRUE(all.insert(attack.text()).second);
  std::set<std::string> both;
  for (const Attack& attack : protocol("benchmark")) both.insert(attack.text());
  EXPECT_TRUE(both.contains("noise:0.5"));
  for (const Attack& attack : protocol("leaks")) both.insert(attack.text());
  EXPECT_EQ(all, both);
  EXPECT_THROW((void)protocol("everything"), Error);
}

}  // namespace
}  // namespace triglyph
