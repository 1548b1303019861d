#include "engine/flux/flux_mark.h"

#include <gtest/gtest.h>

#include "engine/attack/attack.h"
#include "engine/attack/stored_mesh.h"
#include "engine/flux/flux_reading.h"
#include "engine/geometry/box.h"
#include "engine/marking/settle.h"
#include "engine/metric/deformation.h"
#include "tests/flux/flux_shapes.h"
#include "tests/support/arenas.h"
#include "tests/support/shapes.h"

namespace triglyph {
namespace {

const Message kMessage = {'l', 'e', 'a', 'k', ' ', '4', '7', '1', '1'};

FluxMarking marked(const Mesh& mesh, const Key& key = Key::trial(), const FluxBounds& bounds = {},
                   const Message& message = kMessage) {
  const Halfedges halfedges = build_halfedges(mesh);
  return mark_flux({mesh, halfedges}, message, key, bounds, as_float);
}

std::optional<FluxFound> read(const Mesh& mesh, const Key& key = Key::trial(),
                              FluxEffort effort = FluxEffort::All) {
  const Halfedges halfedges = build_halfedges(mesh);
  return read_flux({mesh, halfedges}, key, effort);
}

const Mesh& original() {
  static const Mesh mesh = test::knobbly(60);
  return mesh;
}

const FluxMarking& mark() {
  static const FluxMarking marking = marked(original());
  return marking;
}

Mesh marked_mesh() {
  return {mark().positions, original().triangles};
}

TEST(FluxMark, IsReadBlindAndStandsForItsMessage) {
  ASSERT_EQ(mark().obstacle, FluxObstacle::None);
  const auto found = read(marked_mesh(), Key::trial(), FluxEffort::AsItIs);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->payload, mark().mark.payload);
  EXPECT_GE(found->evidence, kBelieved);
  EXPECT_TRUE(stands_for(found->payload, kMessage, Key::trial()));
  EXPECT_FALSE(stands_for(found->payload, Message{'x'}, Key::trial()));
  EXPECT_FALSE(message_in(found->payload));
}

TEST(FluxMark, IsFoundNeitherUnmarkedNorUnderAnotherKey) {
  EXPECT_FALSE(read(original()));
  EXPECT_FALSE(read(marked_mesh(), Key::trial(5)));
}

TEST(FluxMark, KeepsWithinItsBounds) {
  EXPECT_LE(mark().mark.rms_percent, FluxBounds{}.rms_percent * 1.02);
  FluxBounds bounds;
  bounds.max_percent = 0.15;
  const FluxMarking capped = marked(original(), Key::trial(), bounds);
  ASSERT_EQ(capped.obstacle, FluxObstacle::None);
  const Displacement moves = displacement(original().positions, capped.positions);
  EXPECT_GT(moves.max, 0);
  EXPECT_LE(moves.max / box_diagonal(original().positions) * 100, 0.15);
}

TEST(FluxMark, HoldsAMessageOfTwoBytesItself) {
  const Message short_message = {'o', 'k'};
  const FluxMarking marking = marked(original(), Key::trial(), {}, short_message);
  ASSERT_EQ(marking.obstacle, FluxObstacle::None);
  const auto found = read({marking.positions, original().triangles});
  ASSERT_TRUE(found);
  EXPECT_EQ(message_in(found->payload), short_message);
}

TEST(FluxMark, IsKnownBetterThanItIsRead) {
  const BlockCode code(Key::trial(), mark().mark.payload.content, mark().mark.payload.bits);
  const Mesh mesh = marked_mesh();
  const Halfedges halfedges = build_halfedges(mesh);
  const FluxEvidence known =
      flux_evidence({mesh, halfedges}, Key::trial(), code.encode(mark().mark.payload.value));
  EXPECT_GT(known.evidence, read(mesh)->evidence);
  const FluxEvidence other = flux_evidence({mesh, halfedges}, Key::trial(), code.encode(1));
  EXPECT_LT(other.evidence, 10);
}

class FluxSurvives : public testing::TestWithParam<const char*> {};

TEST_P(FluxSurvives, WhatHappensToCopies) {
  const Mesh attacked = Attack::parsed(GetParam()).applied(marked_mesh(), 3);
  const auto found = read(stored(attacked));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->payload, mark().mark.payload);
}

INSTANTIATE_TEST_SUITE_P(Attacks, FluxSurvives,
                         testing::Values("reorder", "similarity", "mirror", "flip", "noise:0.3",
                                         "smooth:10", "smooth:30", "quantise:10", "midpoint",
                                         "loop", "simplify:50", "remesh", "half", "soup"));

TEST(FluxMark, IsTheSameForAnyThreads) {
  const Mesh mesh = test::knobbly(40);
  test::expect_same_for_any_threads([&] { return marked(mesh).positions; });
}

TEST(FluxMark, NamesWhatStandsInItsWay) {
  EXPECT_EQ(marked(test::flat_grid(30, 30)).obstacle, FluxObstacle::NoVolume);
  EXPECT_EQ(marked(test::sphere(40, 1)).obstacle, FluxObstacle::NoAxes);
  Mesh egg = test::sphere(40, 1);
  for (Vec3& p : egg.positions) p = Vec3(1.02 * p[0], p[1], 0.98 * p[2]);
  EXPECT_EQ(marked(egg).obstacle, FluxObstacle::TooNarrow);
  FluxBounds faint;
  faint.rms_percent = 0.0005;
  EXPECT_EQ(marked(original(), Key::trial(), faint).obstacle, FluxObstacle::TooFaint);
  FluxBounds tight;
  tight.max_percent = 0.0005;
  EXPECT_EQ(marked(original(), Key::trial(), tight).obstacle, FluxObstacle::TooVisible);
}

// A smooth mark turns no face by much.
TEST(FluxMark, LeavesTheShadingAlone) {
  const std::vector<Vec3>& before = original().positions;
  double worst = 0;
  for (const Triangle& t : original().triangles) {
    const Vec3 old_normal = area_normal(before, t);
    const Vec3 new_normal = area_normal(mark().positions, t);
    if (!(old_normal.norm() > 1e-5)) continue;
    worst = std::max(worst, 1 - dot(old_normal.normalized(), new_normal.normalized()));
  }
  EXPECT_LT(worst, 1 - std::cos(12 / 180.0 * M_PI));
}

// Needles, whose height any move exceeds, stay the right way round.
TEST(FluxMark, TurnsNoNeedleOver) {
  Mesh mesh = original();
  std::vector<char> is_taken(mesh.positions.size(), 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 11) {
    const auto [a, b, c] = mesh.triangles[t];
    if (is_taken[a] + is_taken[b] + is_taken[c] > 0) continue;
    is_taken[a] = is_taken[b] = is_taken[c] = 1;
    const Vec3 middle = (mesh.positions[a] + mesh.positions[b]) / 2;
    mesh.positions[c] = middle + 1e-3 * (mesh.positions[c] - middle);
  }
  mesh = stored(mesh);
  const FluxMarking marking = marked(mesh);
  ASSERT_EQ(marking.obstacle, FluxObstacle::None);
  EXPECT_TRUE(flipped_triangles(mesh.triangles, mesh.positions, marking.positions).empty());
}

TEST(FluxPayload, ShowsMessagesAndNumbers) {
  const Message two = {'h', 'i'};
  EXPECT_EQ(shown(flux_payload(two, Key::trial(), 16)), "\"hi\"");
  EXPECT_EQ(shown(flux_payload(kMessage, Key::trial(), 24)).substr(0, 7), "number ");
  EXPECT_EQ(bytes_of(flux_payload(kMessage, Key::trial(), 24)).size(), 3U);
  // a larger number of the same message begins with the smaller
  EXPECT_EQ(flux_payload(kMessage, Key::trial(), 32).value & 0xffff,
            flux_payload(kMessage, Key::trial(), 16).value);
}

}  // namespace
}  // namespace triglyph
