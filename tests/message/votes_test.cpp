#include "engine/message/votes.h"

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

TEST(Votes, APartWithoutVotesIsNothing) {
  const WordCode code(Key::trial(), {6, 4, 8});
  const Votes votes(code);
  for (const auto& part : votes.parts()) EXPECT_FALSE(part);
  EXPECT_EQ(votes.agreement(3), 0);
}

}  // namespace
}  // namespace triglyph
