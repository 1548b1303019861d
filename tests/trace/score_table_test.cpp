#include "engine/trace/score_table.h"

#include <cmath>

#include <gtest/gtest.h>

#include "engine/base/random.h"
#include "tests/support/readings.h"

namespace triglyph {
namespace {

const WordFormat kSmall{.marker_bits = 2, .subscript_bits = 4, .part_bits = 4};

// Readings of every sort: sure and unsure, that agree and that contradict each other.
Votes some_votes(const WordCode& words) {
  Votes votes(words);
  for (std::uint64_t i = 0; i < 60; ++i) {
    const auto draw = [&](std::uint64_t stream) { return random_unit(7, stream, i); };
    Reading reading = test::reading_of(
        {static_cast<std::uint32_t>(draw(0) * 12), static_cast<std::uint32_t>(draw(1) * 16)},
        static_cast<float>(draw(2)));
    reading.bit_weights.fill(static_cast<float>(draw(3)));
    votes.add(reading);
  }
  return votes;
}

// The mean of 2^score over all values of a symbol, as names have them.
double mean_likelihood(const ScoreTable& table, std::size_t at, const FingerprintCode& code) {
  const std::size_t values = std::size_t{1} << table.bits;
  double sum = 0;
  for (std::size_t value = 0; value < values; ++value) {
    double chance = table.layer == FingerprintLayer::Units ? 1 : 1.0 / static_cast<double>(values);
    for (int bit = 0; bit < table.bits && table.layer == FingerprintLayer::Units; ++bit) {
      const double bias =
          code.bias(table.layer, table.symbols[at] * static_cast<unsigned>(table.bits) +
                                     static_cast<unsigned>(bit));
      chance *= (value >> bit & 1) != 0 ? bias : 1 - bias;
    }
    sum += chance * std::exp2(double{table.scores[at * values + value]});
  }
  return sum;
}

// What makes every bound of a false alarm true.
TEST(ScoreTable, HasTheMeanOneOverNames) {
  for (const int resisted : {1, 3, 8}) {
    const FingerprintCode code(Key::trial(), resisted);
    const WordCode words(Key::trial(), kSmall);
    const Votes votes = some_votes(words);
    for (const int colluders : colluders_tried(code)) {
      for (const Votes::Trust& trust : {Votes::Trust{0.95, 3}, Votes::Trust{0.3, 0.5}}) {
        const ScoreTable table = score_votes(votes, words, trust, code, colluders);
        ASSERT_GT(table.symbols.size(), 5U);
        for (std::size_t at = 0; at < table.symbols.size(); ++at) {
          EXPECT_NEAR(mean_likelihood(table, at, code), 1, 1e-4);
        }
      }
    }
  }
  FluxSoftReading reading;
  for (std::size_t i = 0; i < kFunctionals; ++i) {
    reading.phases[i] = {random_unit(3, 0, i), random_unit(3, 1, i), random_unit(3, 2, i),
                         random_unit(3, 3, i) / 2};
  }
  const FingerprintCode code(Key::trial());
  for (const double sharpness : kSharpness) {
    reading.sharpness = sharpness;
    for (const int colluders : {1, 2, 5}) {
      const ScoreTable table = score_flux(reading, colluders);
      for (std::size_t at = 0; at < table.symbols.size(); ++at) {
        EXPECT_FALSE(is_pilot(table.symbols[at]));
        EXPECT_NEAR(mean_likelihood(table, at, code), 1, 1e-4);
      }
    }
  }
}

TEST(ScoreTable, PrefersWhatWasRead) {
  const FingerprintCode code(Key::trial());
  const WordCode words(Key::trial(), kSmall);
  const FingerprintSeed ada = 1, ben = 2;
  Votes votes(words);
  for (std::uint32_t symbol = 0; symbol < 10; ++symbol) {
    Reading reading =
        test::reading_of({symbol, code.symbol(ada, FingerprintLayer::Units, symbol, 4)}, 0.9F);
    reading.bit_weights.fill(0.9F);
    votes.add(reading);
  }
  const ScoreTable alone = score_votes(votes, words, {0.9, 1}, code, 1);
  const ScoreTable with_one = score_votes(votes, words, {0.9, 1}, code, 2);
  EXPECT_GT(alone.score(code, ada), 20);
  EXPECT_LT(alone.score(code, ben), 0);
  // whoever wrote half of the bits is not so sure to be named, nor so sure to be cleared
  EXPECT_LT(with_one.score(code, ada), alone.score(code, ada));
  EXPECT_GT(with_one.score(code, ben), alone.score(code, ben));
  EXPECT_GT(with_one.score(code, ada), 10);
}

TEST(ScoreTable, LeavesThePilotsOutOfTheNames) {
  const FingerprintCode code(Key::trial());
  const FluxPhases ada = phases_of_name(code, 1), ben = phases_of_name(code, 2);
  std::size_t pilots = 0, same = 0;
  for (std::size_t i = 0; i < kFunctionals; ++i) {
    if (is_pilot(i)) {
      ++pilots;
      EXPECT_EQ(ada[i], 0);
    } else if (ada[i] == ben[i]) {
      ++same;
    }
  }
  EXPECT_GT(pilots, kFunctionals / 8);
  EXPECT_LT(pilots, kFunctionals / 2);
  EXPECT_LT(same, kFunctionals / 8);
}

}  // namespace
}  // namespace triglyph
