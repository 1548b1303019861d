#include "engine/message/votes.h"

#include <array>
#include <bit>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/readings.h"

namespace triglyph {
namespace {

TEST(Votes, TheHeavierSideWins) {
  const WordCode code(Key::trial(), {6, 4, 8});
  const Word word = code.fill_words(1)[0];
  const Word wrong{word.subscript, word.part ^ 0x0fU};
  Votes votes(code);
  votes.add(test::reading_of(word, 0.9F));
  votes.add(test::reading_of(wrong, 0.2F));
  votes.add(test::reading_of(wrong, 0.2F));
  EXPECT_EQ(votes.parts()[0], word.part);
  EXPECT_NEAR(votes.agreement(0), (0.9 - 0.4) / 1.3, 1e-6);
  votes.add(test::reading_of(wrong, 0.9F));
  EXPECT_EQ(votes.parts()[0], wrong.part);
}

TEST(Votes, ABitFarFromItsCentreCountsLess) {
  const WordCode code(Key::trial(), {6, 4, 8});
  const Word word = code.fill_words(1)[0];
  Reading doubtful = test::reading_of({word.subscript, word.part ^ 1U}, 1);
  doubtful.bit_weights[0] = 0.1F;
  Votes votes(code);
  votes.add(test::reading_of(word, 0.5F));
  votes.add(doubtful);
  EXPECT_EQ(votes.parts()[0], word.part);
}

// Three look-alikes outweigh the word bit by bit, but not one of them as a whole.
TEST(Votes, ValuesAreVotedOnAsAWhole) {
  const WordCode code(Key::trial(), {6, 4, 8});
  const Word word{code.fill_words(1)[0].subscript, 0x00};
  Votes votes(code);
  votes.add(test::reading_of(word, 1));
  votes.add(test::reading_of({word.subscript, 0x0f}, 0.6F));
  votes.add(test::reading_of({word.subscript, 0x33}, 0.6F));
  votes.add(test::reading_of({word.subscript, 0x55}, 0.6F));
  const auto rankings = votes.rankings();
  EXPECT_EQ(rankings[0].size(), Votes::kRanked);
  EXPECT_EQ(rankings[0][0].part, word.part);
  EXPECT_GT(rankings[0][0].score, rankings[0][1].score);
}

// Against Bayes' rule over all values of a part of three bits.
TEST(Votes, EvidenceOfABitIsItsLikelihoodRatio) {
  const WordCode code(Key::trial(), {6, 4, 3});
  const std::uint32_t subscript = code.fill_words(1)[0].subscript;
  const std::array<std::pair<std::uint32_t, float>, 3> cast = {{{5, 0.9F}, {4, 0.3F}, {2, 0.6F}}};
  Votes votes(code);
  for (const auto& [part, weight] : cast) votes.add(test::reading_of({subscript, part}, weight));
  const Votes::Trust trust{0.5, 2};
  std::array<double, 8> likelihood{};
  for (std::uint32_t value = 0; value < 8; ++value) {
    likelihood[value] = 1;
    for (const auto& [part, weight] : cast) {
      const double genuine = 0.5 * double{weight} * double{weight};
      const int differ = std::popcount(part ^ value);
      // bits at the centres of their cells are wrong once in 21 times; two errors count as chance
      const double seen = differ > 1 ? 0 : std::pow(20.0 / 21, 3) * (differ == 1 ? 0.05 : 1);
      likelihood[value] *= 1 - genuine + genuine * 8 * seen;
    }
  }
  const std::vector<double> evidence = votes.bit_evidence(trust);
  ASSERT_EQ(evidence.size(), 16U * 3);
  for (std::size_t bit = 0; bit < 3; ++bit) {
    double set = 0, clear = 0;
    for (std::uint32_t value = 0; value < 8; ++value) {
      (value >> bit & 1 ? set : clear) += likelihood[value];
    }
    EXPECT_NEAR(evidence[bit], std::log(set / clear), 1e-5) << bit;
  }
  EXPECT_EQ(evidence[3], 0);
}

TEST(Votes, APartWithoutVotesIsNothing) {
  const WordCode code(Key::trial(), {6, 4, 8});
  const Votes votes(code);
  for (const auto& part : votes.parts()) EXPECT_FALSE(part);
  EXPECT_EQ(votes.agreement(3), 0);
}

}  // namespace
}  // namespace triglyph
