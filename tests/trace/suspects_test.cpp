#include "engine/trace/suspects.h"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "engine/base/random.h"
#include "tests/support/arenas.h"
#include "tests/support/readings.h"

namespace triglyph {
namespace {

const WordFormat kFormat{.marker_bits = 6, .subscript_bits = 6, .part_bits = 9};

std::vector<std::vector<std::uint8_t>> many_names(std::size_t count) {
  std::vector<std::vector<std::uint8_t>> names;
  for (std::size_t i = 0; i < count; ++i) {
    const std::string name = "buyer " + std::to_string(i);
    names.emplace_back(name.begin(), name.end());
  }
  return names;
}

// Tables of readings of `genuine` units of a name among four times as many that are random.
std::vector<ScoreTable> tables_for(const FingerprintCode& code, FingerprintSeed seed,
                                   std::uint32_t genuine) {
  const WordCode words(Key::trial(), kFormat);
  Votes votes(words);
  for (std::uint32_t i = 0; i < 5 * genuine; ++i) {
    const auto draw = [&](std::uint64_t stream) { return random_unit(5, stream, i); };
    const auto symbol = static_cast<std::uint32_t>(draw(0) * words.capacity());
    const std::uint32_t part = i < genuine ? code.symbol(seed, FingerprintLayer::Units, symbol, 9)
                                           : static_cast<std::uint32_t>(draw(1) * 512);
    Reading reading =
        test::reading_of({symbol, part}, i < genuine ? 0.8F : static_cast<float>(draw(2) * 0.5));
    reading.bit_weights.fill(0.8F);
    votes.add(reading);
  }
  std::vector<ScoreTable> tables;
  for (const Votes::Trust& trust : {Votes::Trust{0.9, 1}, Votes::Trust{0.5, 0.25}}) {
    for (const int colluders : {1, 2}) {
      tables.push_back(score_votes(votes, words, trust, code, colluders));
      tables.back().what = "units";
      tables.back().prior = -2;
    }
  }
  return tables;
}

TEST(Suspects, TheOneWhoseCopyItIsComesFirst) {
  const FingerprintCode code(Key::trial());
  const auto names = many_names(5000);  // more than are weighed one by one
  const std::vector<FingerprintSeed> seeds = seeds_of(code, names);
  const auto tables = tables_for(code, seeds[4711], 10);
  const std::vector<Scored> best = best_of(tables, code, seeds, 3);
  ASSERT_EQ(best.size(), 3U);
  EXPECT_EQ(best[0].name, 4711U);
  EXPECT_GT(best[0].evidence.bits, 40);
  EXPECT_LT(best[1].evidence.bits, 13);  // about the binary logarithm of the number of names
  for (const Scored& scored : best) {
    const NameEvidence alone = evidence_of(tables, code, seeds[scored.name]);
    EXPECT_EQ(scored.evidence.bits, alone.bits);
    ASSERT_EQ(alone.layers.size(), 1U);
    EXPECT_EQ(alone.layers[0].what, "units");
  }
}

TEST(Suspects, AFirstLookFindsTheSameAsWeighingAll) {
  const FingerprintCode code(Key::trial());
  const auto names = many_names(3000);
  const std::vector<FingerprintSeed> seeds = seeds_of(code, names);
  const auto tables = tables_for(code, seeds[17], 3);  // hardly enough
  const Scored best = best_of(tables, code, seeds, 1).at(0);
  for (std::size_t i = 0; i < seeds.size(); ++i) {
    EXPECT_LE(evidence_of(tables, code, seeds[i]).bits, best.evidence.bits) << i;
  }
}

// The bound that is stated, at a scale at which chance names somebody often.
TEST(Suspects, ChanceNamesNobodyMoreOftenThanTheBoundSays) {
  const FingerprintCode code(Key::trial());
  constexpr std::uint64_t kInnocents = 40000;
  const auto tables = tables_for(code, 1, 12);  // of a mesh that carries another name
  for (const double bits : {2.0, 4.0, 6.0}) {
    std::size_t named = 0;
    for (std::uint64_t seed = 2; seed < kInnocents; ++seed) {
      if (evidence_of(tables, code, mix_bits(seed)).bits >= bits) ++named;
    }
    const double expected = kInnocents * std::exp2(-bits);
    EXPECT_LE(static_cast<double>(named), expected + 5 * std::sqrt(expected)) << bits;
  }
  EXPECT_GT(evidence_of(tables, code, 1).bits, 40);
}

TEST(Suspects, AreTheSameForAnyThreads) {
  const FingerprintCode code(Key::trial());
  const auto names = many_names(2500);
  test::expect_same_for_any_threads([&] {
    const std::vector<FingerprintSeed> seeds = seeds_of(code, names);
    std::vector<std::pair<std::size_t, double>> result;
    for (const Scored& scored : best_of(tables_for(code, seeds[5], 4), code, seeds, 50)) {
      result.emplace_back(scored.name, scored.evidence.bits);
    }
    return result;
  });
}

TEST(Suspects, OfNobodyAreNone) {
  const FingerprintCode code(Key::trial());
  EXPECT_TRUE(best_of(tables_for(code, 1, 3), code, {}, 5).empty());
  const std::vector<FingerprintSeed> seeds = {1, 2};
  const std::vector<Scored> nothing = best_of({}, code, seeds, 5);
  ASSERT_EQ(nothing.size(), 2U);
  EXPECT_EQ(nothing[0].evidence.bits, 0);
}

}  // namespace
}  // namespace triglyph
