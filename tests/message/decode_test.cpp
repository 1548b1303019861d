#include "engine/message/decode.h"

#include <gtest/gtest.h>

#include "tests/support/readings.h"

namespace triglyph {
namespace {

const Message kMessage{'d', 'o', 'u', 'b', 't'};

// Votes for the message in which the wrong value leads in some parts.
Votes votes_with(const WordCode& code, const std::vector<std::size_t>& wrong_parts) {
  Votes votes(code);
  const auto words = code.words_of(kMessage);
  for (std::size_t i = 0; i < words.size(); ++i) {
    const bool wrong = std::find(wrong_parts.begin(), wrong_parts.end(), i) != wrong_parts.end();
    votes.add(test::reading_of(words[i], wrong ? 0.5F : 1.0F));
    votes.add(test::reading_of({words[i].subscript, words[i].part ^ 5U}, wrong ? 0.6F : 0.2F));
  }
  return votes;
}

TEST(Decode, TakesTheBestOfEachPart) {
  const WordCode code(Key::trial(), {1, 5, 4});
  const Decoded decoded = decode(votes_with(code, {}), code, 0);
  EXPECT_EQ(decoded.message, kMessage);
  EXPECT_EQ(decoded.false_alarm, 0x1p-32);
}

TEST(Decode, DoubtsThePartsWithTheLeastLead) {
  const WordCode code(Key::trial(), {1, 5, 4});
  for (const std::vector<std::size_t>& wrong :
       {std::vector<std::size_t>{7}, {0, 9}, {1, 4, 12, 19}, {0, 1, 5, 6, 7, 8}}) {
    const Votes votes = votes_with(code, wrong);
    EXPECT_FALSE(decode(votes, code, 0).message);
    const Decoded decoded = decode(votes, code, 8);
    EXPECT_EQ(decoded.message, kMessage);
    EXPECT_EQ(decoded.false_alarm, 0x1p-24);
  }
  EXPECT_FALSE(decode(votes_with(code, {2, 3, 4, 5, 6, 7, 8, 9, 10}), code, 8).message);
}

TEST(Decode, OfNoVotesIsNothing) {
  const WordCode code(Key::trial(), {1, 5, 4});
  EXPECT_FALSE(decode(Votes(code), code, 0).message);
  EXPECT_FALSE(decode(Votes(code), code, 8).message);
}

}  // namespace
}  // namespace triglyph
