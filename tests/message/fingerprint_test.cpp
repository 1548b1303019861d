#include "engine/message/fingerprint.h"

#include <cmath>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "engine/base/error.h"

namespace triglyph {
namespace {

constexpr auto kUnits = FingerprintLayer::Units;

FingerprintSeed seed_of(const FingerprintCode& code, const std::string& name) {
  return code.seed_of(std::vector<std::uint8_t>(name.begin(), name.end()));
}

TEST(FingerprintCode, IsAFunctionOfKeyAndName) {
  const FingerprintCode code(Key::trial()), other(Key::trial(1));
  EXPECT_EQ(seed_of(code, "Ada"), seed_of(FingerprintCode(Key::trial()), "Ada"));
  EXPECT_NE(seed_of(code, "Ada"), seed_of(code, "Ben"));
  EXPECT_NE(seed_of(code, "Ada"), seed_of(other, "Ada"));
  EXPECT_THROW(FingerprintCode(Key::trial(), 0), Error);
  EXPECT_THROW(FingerprintCode(Key::trial(), kMostColluders + 1), Error);
}

TEST(FingerprintCode, DrawsEveryBitWithItsBias) {
  constexpr int kNames = 4000;
  for (const int colluders : {1, 2, 3, 6, 8}) {
    const FingerprintCode code(Key::trial(), colluders);
    EXPECT_EQ(code.is_fair(), colluders <= 2);
    std::set<double> biases;
    for (std::uint32_t symbol = 0; symbol < 16; ++symbol) {
      for (std::uint32_t bit = 0; bit < 4; ++bit) {
        const double bias = code.bias(kUnits, symbol * 4 + bit);
        biases.insert(bias);
        int set = 0;
        for (std::uint64_t name = 0; name < kNames; ++name) {
          set += static_cast<int>(code.symbol(name, kUnits, symbol, 4) >> bit & 1);
        }
        const double deviation = std::sqrt(kNames * bias * (1 - bias));
        EXPECT_NEAR(set, kNames * bias, 5 * deviation) << colluders;
      }
    }
    EXPECT_EQ(biases.size(), static_cast<std::size_t>((colluders + 1) / 2));
  }
}

TEST(FingerprintCode, FillsTheBitsOfASymbol) {
  const FingerprintCode code(Key::trial());
  for (const int bits : {1, 4, 9, 12, 32}) {
    std::uint32_t all = 0;
    for (std::uint64_t name = 0; name < 200; ++name) {
      const std::uint32_t value = code.symbol(name, kUnits, 3, bits);
      if (bits < 32) {
        EXPECT_LT(value, 1U << bits);
      }
      all |= value;
    }
    EXPECT_EQ(all, static_cast<std::uint32_t>((std::uint64_t{1} << bits) - 1));
  }
}

}  // namespace
}  // namespace triglyph
