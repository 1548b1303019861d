#include "engine/survival/survival.h"

#include <algorithm>

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include "engine/attack/stored_mesh.h"
#include "engine/base/error.h"
#include "engine/samples/sample_shapes.h"
#include "engine/survival/trial.h"
#include "tests/support/shapes.h"

namespace triglyph {
namespace {

MarkRequest request_for(const std::string& scheme) {
  return resolve({{"scheme", scheme}, {"message", std::string("survives")}});
}

std::vector<Attack> attacks(std::initializer_list<const char*> texts) {
  std::vector<Attack> all;
  for (const char* text : texts) all.push_back(Attack::parsed(text));
  return all;
}

TEST(Survival, TellsHarmlessAttacksFromDeadlyOnes) {
  const SchemeSurvival result =
      survive(test::bumpy_ball().mesh, request_for("tsq"),
              attacks({"none", "reorder+soup", "noise:0.1", "voxel:16"}), {.keys = 3, .seed = 4});
  EXPECT_EQ(result.meshes_tried, 3U);
  ASSERT_EQ(result.marked, 3U) << result.refusal;
  ASSERT_EQ(result.attacks.size(), 4U);
  for (const std::size_t harmless : {0U, 1U}) {
    EXPECT_EQ(result.attacks[harmless].recovered, 3U);
    EXPECT_EQ(result.attacks[harmless].wrong_bits, (std::vector<double>{0, 0, 0}));
    EXPECT_EQ(result.attacks[harmless].worst_false_alarm, 0x1p-32);
  }
  EXPECT_EQ(result.attacks[2].recovered, 0U);
  EXPECT_GT(result.attacks[2].median_wrong_bits(), 0.25);  // as good as random
  EXPECT_EQ(result.attacks[3].recovered, 0U);
  EXPECT_GT(result.attacks[3].worst_wrong_bits(), 0.25);
  EXPECT_EQ(result.attacks[3].worst_false_alarm, 0);
}

// A strong mark in units survives what a normal one does not, and can be cropped besides.
TEST(Survival, OfStrongMarksIsGreater) {
  const auto attacked = attacks({"noise:0.1", "quantise:10", "crop:50+noise:0.05", "smooth:1"});
  const Mesh mesh = make_sample_shape(SampleShape::Closed, 16000, 3);
  for (const char* strength : {"normal", "strong"}) {
    const MarkRequest request =
        resolve({{"scheme", "tsq"}, {"message", "survives"}, {"strength", strength}});
    const SchemeSurvival result = survive(mesh, request, attacked, {.keys = 2});
    ASSERT_EQ(result.marked, 2U) << result.refusal;
    const bool is_strong = strength == std::string("strong");
    for (const AttackSurvival& attack : result.attacks) {
      EXPECT_EQ(attack.recovered, is_strong ? 2U : 0U) << attack.attack << " " << strength;
    }
  }
}

TEST(Survival, MeasuresTheMarkBeforeTheAttacks) {
  const Mesh& mesh = test::bumpy_ball().mesh;
  const MarkDistortion usual = survive(mesh, request_for("tsq"), {}, {.keys = 1}).distortion;
  EXPECT_GT(usual.mrms_rel_diag, 0);
  EXPECT_GT(usual.hausdorff_rel_diag, usual.mrms_rel_diag);
  EXPECT_GT(usual.msdm2, 0);
  EXPECT_GT(usual.normal_max_degrees, usual.normal_mean_degrees);
  EXPECT_GT(usual.normal_mean_degrees, 0);
  MarkRequest sparse = request_for("tsq");
  sparse.options.redundancy = 4;
  const MarkDistortion few = survive(mesh, sparse, {}, {.keys = 1}).distortion;
  EXPECT_LT(few.msdm2, usual.msdm2);
  EXPECT_LT(few.normal_mean_degrees, usual.normal_mean_degrees);
}

TEST(Survival, IsTheSameForAnyNumberOfThreads) {
  const auto measured = [](int threads) {
    tbb::task_arena arena(threads);
    return arena.execute([] {
      return survive(test::bumpy_ball().mesh, request_for("tsq"),
                     attacks({"noise:0.01", "simplify:30", "crop:50"}), {.keys = 2, .seed = 9});
    });
  };
  const SchemeSurvival alone = measured(1);
  EXPECT_EQ(measured(3), alone);
  // other keys are other marks, whose bits are lost elsewhere
  EXPECT_NE(alone.attacks[1].wrong_bits[0], alone.attacks[1].wrong_bits[1]);
}

TEST(Survival, OfAMeshThatCannotBeMarkedSaysWhy) {
  const SchemeSurvival result =
      survive(test::tetrahedron(), request_for("tsq"), attacks({"none"}), {.keys = 2});
  EXPECT_EQ(result.meshes_tried, 2U);
  EXPECT_EQ(result.marked, 0U);
  EXPECT_NE(result.refusal, "");
  EXPECT_TRUE(result.attacks[0].wrong_bits.empty());
  EXPECT_EQ(result.attacks[0].worst_wrong_bits(), 1);
  EXPECT_EQ(result.distortion, MarkDistortion{});
}

TEST(Survival, OfSeveralMeshesAddsCountsAndKeepsTheWorst) {
  SchemeSurvival first{4, 4, "", {0.1, 0.5, 0.2, 1, 9}, {{"none", {0, 0.5}, 2, 1e-9, 0}}};
  SchemeSurvival second{4, 2, "too small", {0.3, 0.4, 0.4, 3, 8}, {{"none", {0.25}, 1, 1e-6, 1}}};
  SchemeSurvival third{4, 0, "too coarse", {}, {{"none", {}, 0, 0, 0}}};
  const SchemeSurvival parts[] = {first, second, third};
  const SchemeSurvival all = combined(parts);
  EXPECT_EQ(all.meshes_tried, 12U);
  EXPECT_EQ(all.marked, 6U);
  EXPECT_EQ(all.refusal, "too small");
  EXPECT_DOUBLE_EQ(all.distortion.mrms_rel_diag, 0.2);
  EXPECT_EQ(all.distortion.hausdorff_rel_diag, 0.5);
  EXPECT_DOUBLE_EQ(all.distortion.normal_mean_degrees, 2);
  EXPECT_EQ(all.distortion.normal_max_degrees, 9);
  EXPECT_EQ(all.attacks[0], (AttackSurvival{"none", {0, 0.5, 0.25}, 3, 1e-6, 1}));
  EXPECT_EQ(all.attacks[0].median_wrong_bits(), 0.25);
  EXPECT_EQ(all.attacks[0].worst_wrong_bits(), 0.5);
}

TEST(Trial, MarksReadBackUnderTheirOwnKeyAlone) {
  const Mesh mesh = stored(test::bumpy_ball().mesh);
  const TrialMark mark = mark_for_trial(mesh, request_for("tsq"), Key::trial(1));
  ASSERT_TRUE(mark.is_marked()) << mark.refusal;
  EXPECT_NE(mark.mesh.positions, mesh.positions);
  EXPECT_EQ(stored(mark.mesh).positions, mark.mesh.positions);  // floats already
  EXPECT_TRUE(read_for_trial(mark.mesh, mark, Key::trial(1)).is_recovered);
  const TrialReading other = read_for_trial(mark.mesh, mark, Key::trial(2));
  EXPECT_FALSE(other.is_recovered);
  EXPECT_GT(other.wrong_bits, 0.25);
  EXPECT_FALSE(read_for_trial(mesh, mark, Key::trial(1)).is_recovered);
  EXPECT_EQ(read_for_trial({}, mark, Key::trial(1)).wrong_bits, 1);
  EXPECT_THROW((void)mark_for_trial(mesh, resolve({{"fill", true}}), Key::trial(1)), Error);
}

}  // namespace
}  // namespace triglyph
