#include "engine/scheme/quantiser.h"

#include <bit>
#include <limits>

#include <gtest/gtest.h>

#include "engine/base/random.h"

namespace triglyph {
namespace {

TEST(Quantiser, CentresCarryTheirBitsAndAreTheNearest) {
  for (std::uint64_t i = 0; i < 2000; ++i) {
    const int bits = static_cast<int>(random_bits(1, 0, i) % 9);
    const double step = 0.001 + 0.1 * random_unit(1, 1, i);
    const Quantiser quantiser(step, bits, random_unit(1, 2, i));
    const double value = 20 * random_unit(1, 3, i) - 10;
    const auto wanted = static_cast<std::uint32_t>(random_bits(1, 4, i)) & ((1U << bits) - 1);
    const double centre = quantiser.nearest_centre(value, wanted);
    EXPECT_EQ(quantiser.cell_of(centre).bits, wanted);
    EXPECT_LT(quantiser.cell_of(centre).distance, 1e-6);
    EXPECT_LE(std::abs(centre - value), quantiser.period() / 2 * (1 + 1e-9));
    const double second = quantiser.second_centre(value, centre);
    EXPECT_EQ(quantiser.cell_of(second).bits, wanted);
    EXPECT_LE((centre - value) * (second - value), 0);
  }
}

TEST(Quantiser, NeighbouringCellsDifferInOneBit) {
  const Quantiser quantiser(0.1, 5, 0.3);
  for (int cell = -100; cell < 100; ++cell) {
    const auto here = quantiser.cell_of((cell + 0.5 - 0.3) * 0.1).bits;
    const auto there = quantiser.cell_of((cell + 1.5 - 0.3) * 0.1).bits;
    EXPECT_EQ(std::popcount(here ^ there), 1) << cell;
  }
}

TEST(Quantiser, DistanceGrowsFromCentreToBorder) {
  const Quantiser quantiser(2, 3, 0);
  EXPECT_NEAR(quantiser.cell_of(1).distance, 0, 1e-6);
  EXPECT_NEAR(quantiser.cell_of(1.5).distance, 0.5, 1e-6);
  EXPECT_NEAR(quantiser.cell_of(0.5).distance, 0.5, 1e-6);
  EXPECT_NEAR(quantiser.cell_of(2).distance, 1, 1e-6);
}

TEST(Quantiser, DegenerateValuesAreOnABorder) {
  const Quantiser quantiser(0.01, 3, 0);
  EXPECT_EQ(quantiser.cell_of(std::numeric_limits<double>::quiet_NaN()).distance, 1);
  EXPECT_EQ(quantiser.cell_of(std::numeric_limits<double>::infinity()).distance, 1);
  EXPECT_EQ(quantiser.cell_of(1e300).distance, 1);
}

}  // namespace
}  // namespace triglyph
