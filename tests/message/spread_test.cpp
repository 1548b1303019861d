#include "engine/message/spread.h"

#include <cmath>

#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "engine/base/random.h"
#include "engine/message/decode.h"

namespace triglyph {
namespace {

constexpr WordFormat kFormat{0, 10, 3, true};

Message message_of(std::size_t bytes) {
  Message message(bytes);
  for (std::size_t i = 0; i < bytes; ++i) {
    message[i] = static_cast<std::uint8_t>(random_bits(bytes, 1, i));
  }
  return message;
}

// Votes of `units` words drawn at random, of which `wrong` have random bits.
Votes votes_of(const WordCode& code, std::span<const Word> words, std::size_t units,
               std::size_t wrong, std::uint64_t seed) {
  Votes votes(code);
  for (std::size_t i = 0; i < units; ++i) {
    Reading reading;
    reading.word = words[random_bits(seed, 2, i) % words.size()];
    if (i < wrong) reading.word.part = static_cast<std::uint32_t>(random_bits(seed, 3, i) & 7);
    reading.weight = 1;
    reading.bit_weights.fill(1);
    votes.add(reading);
  }
  return votes;
}

TEST(SpreadWords, ALittleMoreThanTheBitsOfAMessageSufficesWhicheverTheyAre) {
  const WordCode code(Key::trial(), kFormat);
  for (std::size_t bytes = 1; bytes <= kMaxSpreadBytes; ++bytes) {
    const Message message = message_of(bytes);
    const std::vector<Word> words = code.words_of(message);
    EXPECT_EQ(words.size(), code.capacity());
    const std::size_t units = least_units_for(kFormat, bytes) + 8;
    for (std::uint64_t seed = 0; seed < 4; ++seed) {
      const Decoded decoded = decode(votes_of(code, words, units, 0, seed), code, 0);
      EXPECT_EQ(decoded.message, message) << bytes << " bytes, seed " << seed;
      EXPECT_EQ(decoded.false_alarm, 0x1p-28);
    }
  }
}

TEST(SpreadWords, AThirdOfWrongWordsIsCorrected) {
  const WordCode code(Key::trial(), kFormat);
  const Message message = message_of(8);
  const std::vector<Word> words = code.words_of(message);
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    EXPECT_EQ(decode(votes_of(code, words, 150, 50, seed), code, 0).message, message) << seed;
  }
}

TEST(SpreadWords, AreReadUnderTheirKeyAloneAndRandomOnesNever) {
  const WordCode code(Key::trial(), kFormat);
  const std::vector<Word> words = code.words_of(message_of(8));
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    EXPECT_FALSE(decode(votes_of(code, words, 200, 200, seed), code, 0).message);
    const WordCode other(Key::generate(), kFormat);
    EXPECT_FALSE(decode(votes_of(other, words, 200, 0, seed), other, 0).message);
  }
  EXPECT_FALSE(decode(Votes(code), code, 0).message);
}

TEST(SpreadWords, HoldAMessageOf16BytesAtMost) {
  EXPECT_NO_THROW(check_message(kFormat, 16));
  EXPECT_THROW(check_message(kFormat, 17), Error);
  EXPECT_THROW(check_message(kFormat, 0), Error);
}

// Against all payloads of a few bits: that found agrees best with the values read, of parities and
// of its own bits.
TEST(SpreadCode, FindsThePayloadThatAgreesBest) {
  for (const std::size_t bits : {1U, 5U, 8U, 13U}) {
    const SpreadCode code(7, bits);
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
      std::vector<SoftParity> parities;
      for (std::uint32_t row = 0; row < 3 * bits; ++row) {
        parities.push_back({row, 2 * random_unit(seed, 1, row) - 1});
      }
      std::vector<SoftBit> own;
      for (std::size_t bit = 0; bit < bits; bit += 2) {
        own.push_back({bit, 2 * random_unit(seed, 2, bit) - 1});
      }
      const auto agreement = [&](std::span<const std::uint8_t> payload) {
        double sum = 0;
        for (const SoftBit& b : own) {
          sum += (payload[b.bit / 8] >> (b.bit % 8) & 1) != 0 ? b.value : -b.value;
        }
        for (const SoftParity& p : parities)
          sum += code.parity(payload, p.row) ? p.value : -p.value;
        return sum;
      };
      double best = -1e9;
      for (std::uint32_t value = 0; value < 1U << bits; ++value) {
        const std::uint8_t bytes[2] = {static_cast<std::uint8_t>(value),
                                       static_cast<std::uint8_t>(value >> 8)};
        best = std::max(best, agreement(bytes));
      }
      EXPECT_NEAR(agreement(code.decode(parities, own)), best, 1e-4)
          << bits << " bits, seed " << seed;
    }
  }
}

// The bound of a false alarm in small: of what decoding makes of random votes, the low bits of the
// tag fit as seldom as chance lets them, for each length that is tried.
TEST(SpreadCode, GivesTagsThatFitByChanceAlone) {
  constexpr int kDraws = 4000;
  constexpr std::uint32_t kLowBits = 15;
  const Key key = Key::trial();
  int fits = 0;
  for (std::uint64_t seed = 0; seed < kDraws; ++seed) {
    const std::size_t bytes = 1 + seed % 3;
    const SpreadCode code(11, 8 * bytes + 32);
    std::vector<SoftParity> parities;
    for (std::uint32_t row = 0; row < 120; ++row) {
      parities.push_back({row, 2 * random_unit(seed, 1, row) - 1});
    }
    const std::vector<std::uint8_t> payload = code.decode(parities);
    const std::uint32_t tag = key.tag(std::span(payload).first(bytes));
    fits += (tag & kLowBits) == (payload[bytes] & kLowBits) ? 1 : 0;
  }
  // a sixteenth, give or take four standard deviations
  EXPECT_NEAR(fits, kDraws / 16.0, 4 * std::sqrt(kDraws / 16.0));
}

}  // namespace
}  // namespace triglyph
