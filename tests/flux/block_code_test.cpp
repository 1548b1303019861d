#include "engine/flux/block_code.h"

#include <gtest/gtest.h>

#include "engine/base/random.h"

namespace triglyph {
namespace {

// Soft values as `used` functionals with some noise give them for a word.
SoftBits soft_of(const FluxBits& word, std::size_t used, double noise, std::uint64_t seed) {
  SoftBits soft;
  for (std::size_t i = 0; i < used; ++i) {
    const double error =
        noise * (random_unit(seed, 0, i) + random_unit(seed, 1, i) + random_unit(seed, 2, i) - 1.5);
    soft.ratio[i] = 4 * ((word[i] == 0 ? 1 : -1) + error);
  }
  return soft;
}

std::uint64_t payload_of(int bits, std::uint64_t seed) {
  return random_bits(seed, 7, 0) & ~std::uint64_t{0} >> (64 - bits);
}

TEST(BlockCode, BringsPayloadsOfEverySizeBack) {
  for (const int bits : kPayloadBits) {
    for (const FluxContent content : kFluxContents) {
      const BlockCode code(Key::trial(), content, bits);
      for (std::uint64_t seed = 0; seed < 20; ++seed) {
        const std::uint64_t payload = payload_of(bits, seed);
        const auto used = static_cast<std::size_t>(2 * bits);
        EXPECT_EQ(code.decode(SoftOrder(soft_of(code.encode(payload), used, 0, seed))), payload)
            << bits;
      }
    }
  }
}

TEST(BlockCode, CorrectsFunctionalsThatSayTheWrongBit) {
  const BlockCode code(Key::trial(), FluxContent::Number, 16);
  int wrong_bits = 0;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const std::uint64_t payload = payload_of(16, seed);
    const FluxBits word = code.encode(payload);
    const SoftBits soft = soft_of(word, 60, 1.6, seed);
    for (std::size_t i = 0; i < 60; ++i) wrong_bits += (soft.ratio[i] < 0) != (word[i] != 0);
    EXPECT_EQ(code.decode(SoftOrder(soft)), payload) << seed;
  }
  EXPECT_GT(wrong_bits, 50);  // more than one a word, so that hard decisions would not do
}

// A reader that asks for evidence loses none of the words that have it.
TEST(BlockCode, LeavesOutNothingButWordsOfLessEvidence) {
  int kept = 0, left_out = 0;
  for (const int bits : kPayloadBits) {
    const BlockCode code(Key::trial(), FluxContent::Number, bits);
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
      const double noise = static_cast<double>(seed % 8) / 2;
      const SoftBits soft = soft_of(code.encode(payload_of(bits, seed)), 120, noise, seed);
      const SoftOrder order(soft);
      const auto found = code.decode(order);
      const double least = static_cast<double>(seed % 5) * 0.3 * soft.most_evidence();
      const bool suffices = found && soft.evidence(code.encode(*found)) >= least;
      if (suffices) {
        EXPECT_EQ(code.decode(order, least), found) << bits << " " << seed;
        ++kept;
      } else if (found) {
        const auto other = code.decode(order, least);
        EXPECT_TRUE(!other || soft.evidence(code.encode(*other)) >= least - 1e-6);
        ++left_out;
      }
    }
  }
  EXPECT_GT(kept, 100);
  EXPECT_GT(left_out, 20);
}

TEST(BlockCode, SaysNothingWhereAnotherWordIsNearlyAsGood) {
  const BlockCode code(Key::trial(), FluxContent::Number, 16);
  SoftBits soft = soft_of(code.encode(0x1234), 60, 0, 1);
  const FluxBits other = code.encode(0x4321);
  const FluxBits word = code.encode(0x1234);
  for (std::size_t i = 0; i < 60; ++i) {
    if (word[i] != other[i]) soft.ratio[i] *= 0.01;  // halfway between the two
  }
  EXPECT_FALSE(code.decode(SoftOrder(soft)));
}

TEST(BlockCode, SaysNothingWithFewerFunctionalsThanBits) {
  const BlockCode code(Key::trial(), FluxContent::Bytes, 32);
  EXPECT_FALSE(code.decode(SoftOrder(soft_of(code.encode(1), 31, 0, 1))));
}

TEST(BlockCode, OfEachContentAndKeyIsAnother) {
  const FluxBits bytes = BlockCode(Key::trial(), FluxContent::Bytes, 16).encode(5);
  const FluxBits number = BlockCode(Key::trial(), FluxContent::Number, 16).encode(5);
  const FluxBits other = BlockCode(Key::trial(1), FluxContent::Bytes, 16).encode(5);
  std::size_t differ = 0;
  std::size_t differ_by_key = 0;
  for (std::size_t i = 0; i < kFunctionals; ++i) {
    differ += bytes[i] != number[i];
    differ_by_key += bytes[i] != other[i];
  }
  EXPECT_NEAR(static_cast<double>(differ), 80, 30);
  EXPECT_NEAR(static_cast<double>(differ_by_key), 80, 30);
}

}  // namespace
}  // namespace triglyph
