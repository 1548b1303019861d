#include "engine/message/decode.h"

#include <gtest/gtest.h>

#include "engine/base/random.h"
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

// Votes for some words of a message of 8 bytes, `copies` each, of which the first `lost` are lost.
Votes coded_votes(const WordCode& code, std::uint32_t count, std::size_t copies, std::size_t lost) {
  const Message message{'p', 'a', 'r', 'i', 't', 'i', 'e', 's'};
  const std::vector<Word> words = code.words_of(message, count);
  Votes votes(code);
  for (std::size_t i = lost; i < words.size(); ++i) {
    for (std::size_t copy = 0; copy < copies; ++copy) votes.add(test::reading_of(words[i], 0.8F));
  }
  return votes;
}

TEST(Decode, ParitiesReplaceLostParts) {
  const WordCode code(Key::trial(), {6, 8, 9});
  const Message message{'p', 'a', 'r', 'i', 't', 'i', 'e', 's'};
  ASSERT_EQ(code.words_of(message).size(), 12U);
  EXPECT_FALSE(correct(coded_votes(code, 12, 4, 1), code).message);
  for (const std::size_t lost : {1U, 6U, 12U}) {
    const Votes votes = coded_votes(code, 36, 4, lost);
    EXPECT_FALSE(decode(votes, code, 0).message);
    const Decoded decoded = correct(votes, code);
    EXPECT_EQ(decoded.message, message) << lost;
    EXPECT_GT(decoded.false_alarm, 0x1p-29);
    EXPECT_LT(decoded.false_alarm, 0x1p-26);
  }
  EXPECT_FALSE(correct(coded_votes(code, 36, 4, 28), code).message);
}

// Every word has one genuine reading among three random ones, most of lesser weight, and every
// fourth has none: the best values of the parts do not give the message.
TEST(Decode, ParitiesCorrectErrors) {
  const WordCode code(Key::trial(), {6, 8, 9});
  const Message message{'p', 'a', 'r', 'i', 't', 'i', 'e', 's'};
  const std::vector<Word> words = code.words_of(message, 48);
  int read = 0;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    Votes votes(code);
    for (std::uint32_t i = 0; i < words.size(); ++i) {
      if (i % 4 != 0) votes.add(test::reading_of(words[i], 0.8F));
      for (std::uint32_t j = 0; j < 3; ++j) {
        const auto part = static_cast<std::uint32_t>(random_bits(seed, i, j) & 511);
        const double weight = random_unit(seed, 1000 + i, j);
        votes.add(test::reading_of({words[i].subscript, part},
                                   static_cast<float>(weight * weight * weight)));
      }
    }
    EXPECT_FALSE(decode(votes, code, 0).message);
    const Decoded decoded = correct(votes, code);
    read += decoded.message == message ? 1 : 0;
    EXPECT_TRUE(!decoded.message || decoded.message == message);
  }
  EXPECT_GE(read, 8);
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
