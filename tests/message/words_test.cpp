#include "engine/message/words.h"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "engine/base/random.h"

namespace triglyph {
namespace {

Message random_message(std::size_t bytes, std::uint64_t seed) {
  Message message(bytes);
  for (std::size_t i = 0; i < bytes; ++i) {
    message[i] = static_cast<std::uint8_t>(random_bits(seed, bytes, i));
  }
  return message;
}

std::vector<std::optional<std::uint32_t>> parts_of(const WordCode& code,
                                                   const std::vector<Word>& words) {
  std::vector<std::optional<std::uint32_t>> parts(code.capacity());
  for (const Word& word : words) parts[code.part_index(word.subscript)] = word.part;
  return parts;
}

class WordFormats : public testing::TestWithParam<WordFormat> {};

TEST_P(WordFormats, MessagesOfEveryLengthComeBack) {
  const WordCode code(Key::trial(), GetParam());
  for (std::size_t bytes = 1; bytes <= 256; ++bytes) {
    if (parts_for(code.format(), bytes) > code.capacity()) {
      EXPECT_THROW((void)code.words_of(random_message(bytes, 1)), Error);
      continue;
    }
    const Message message = random_message(bytes, 1);
    const std::vector<Word> words = code.words_of(message);
    EXPECT_EQ(words.size(), parts_for(code.format(), bytes));
    EXPECT_EQ(code.message_of(parts_of(code, words)), message);
  }
}

INSTANTIATE_TEST_SUITE_P(All, WordFormats,
                         testing::Values(WordFormat{6, 8, 12}, WordFormat{8, 8, 16},
                                         WordFormat{4, 4, 7}, WordFormat{6, 12, 2},
                                         WordFormat{1, 16, 32}));

TEST(WordCode, SubscriptsAreDistinctAndInvertible) {
  const WordCode code(Key::trial(), {6, 8, 12});
  std::set<std::uint32_t> subscripts;
  const auto words = code.fill_words(256);
  for (std::uint32_t i = 0; i < words.size(); ++i) {
    subscripts.insert(words[i].subscript);
    EXPECT_EQ(code.part_index(words[i].subscript), i);
    EXPECT_LT(words[i].part, 1U << 12);
  }
  EXPECT_EQ(subscripts.size(), 256U);
  EXPECT_THROW((void)code.fill_words(257), Error);
}

TEST(WordCode, OneWrongBitOrAMissingPartIsNoMessage) {
  const WordCode code(Key::trial(), {6, 8, 12});
  const auto parts = parts_of(code, code.words_of(random_message(8, 2)));
  for (std::uint32_t part = 0; part < parts_for(code.format(), 8); ++part) {
    auto damaged = parts;
    damaged[part].reset();
    EXPECT_FALSE(code.message_of(damaged));
  }
  // 104 payload bits stand in 9 parts of 12; the 4 bits behind them carry nothing
  for (std::uint32_t bit = 0; bit < 104; ++bit) {
    auto damaged = parts;
    *damaged[bit / 12] ^= 1U << (bit % 12);
    EXPECT_FALSE(code.message_of(damaged)) << "bit " << bit;
  }
}

TEST(WordCode, AnotherKeyReadsNothing) {
  const WordCode code(Key::trial(), {6, 8, 12});
  const auto words = code.words_of(random_message(8, 3));
  for (int i = 0; i < 50; ++i) {
    const WordCode other(Key::generate(), {6, 8, 12});
    EXPECT_FALSE(other.message_of(parts_of(other, words)));
  }
}

TEST(WordCode, RefusesWhatCannotBe) {
  const WordCode code(Key::trial(), {6, 3, 12});
  EXPECT_THROW((void)code.words_of(random_message(8, 4)), Error);  // 9 parts, 8 subscripts
  EXPECT_THROW((void)code.words_of(Message{}), Error);
  EXPECT_THROW((void)code.words_of(random_message(257, 4)), Error);
  EXPECT_THROW(WordCode(Key::trial(), {-1, 8, 12}), Error);
  EXPECT_THROW(WordCode(Key::trial(), {17, 8, 12}), Error);
  EXPECT_THROW(WordCode(Key::trial(), {6, 17, 12}), Error);
  EXPECT_THROW(WordCode(Key::trial(), {6, 8, 33}), Error);
}

// Every file ever marked depends on these values.
TEST(WordCode, NeverChanges) {
  const WordCode code(Key::trial(), {6, 8, 12});
  const auto words = code.words_of(Message{'t', 'r', 'i', 'g', 'l', 'y', 'p', 'h'});
  ASSERT_EQ(words.size(), 9U);
  EXPECT_EQ(code.marker(), 20U);
  EXPECT_EQ(words[0], (Word{0x9f, 0xc7c}));
  EXPECT_EQ(words[8], (Word{0x33, 0xec4}));
}

// The words that a message needs come first and stay what they are: older readers know these alone.
TEST(Words, OthersWithParitiesFollowThoseOfTheMessage) {
  const WordCode code(Key::trial(), {6, 8, 9});
  for (const std::size_t bytes : {1U, 8U, 16U}) {
    const Message message = random_message(bytes, 5);
    const std::vector<Word> needed = code.words_of(message);
    const std::vector<Word> all = code.words_of(message, code.most_words(bytes));
    EXPECT_EQ(all.size(), code.capacity());
    EXPECT_TRUE(std::equal(needed.begin(), needed.end(), all.begin()));
    EXPECT_EQ(code.words_of(message, 1), needed);
    std::vector<char> is_used(code.capacity(), 0);
    for (const Word& word : all) is_used[word.subscript] = 1;
    EXPECT_EQ(std::count(is_used.begin(), is_used.end(), 1), code.capacity());
  }
  const Message longer = random_message(17, 5);
  EXPECT_EQ(code.words_of(longer, code.capacity()), code.words_of(longer));
}

}  // namespace
}  // namespace triglyph
