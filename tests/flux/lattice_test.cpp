#include "engine/flux/lattice.h"

#include <gtest/gtest.h>

#include "engine/base/random.h"
#include "engine/flux/evidence.h"

namespace triglyph {
namespace {

std::array<std::uint8_t, kFunctionals> same_axes() {
  std::array<std::uint8_t, kFunctionals> source{};
  for (std::size_t i = 0; i < kFunctionals; ++i) source[i] = static_cast<std::uint8_t>(i);
  return source;
}

// A surface of which `count` functionals have equal shares, and no other has any.
FluxValues even_values(std::size_t count) {
  FluxValues values;
  for (std::size_t i = 0; i < count; ++i) {
    values.weight[i] = 1;
    values.flux[i] = 0.1 * random_unit(3, 0, i);
  }
  return values;
}

TEST(Measured, UsesWhatHasAShareOfTheSurface) {
  FluxValues values = even_values(64);
  values.weight[5] = 0.05;
  const Measurement measurement = measured(values);
  EXPECT_EQ(measurement[0].used, 1);
  EXPECT_EQ(measurement[5].used, 0);
  EXPECT_EQ(measurement[70].used, 0);
  EXPECT_EQ(measurement[0].rung, 0);
  EXPECT_LT(measurement[0].other_weight, 1e-3);
}

TEST(Measured, WeighsBothRungsAtTheirBorder) {
  FluxValues values = even_values(64);
  values.weight[7] = M_SQRT2;
  const Measured m = measured(values)[7];
  EXPECT_NEAR(m.other_weight, 0.5, 0.2);
  EXPECT_EQ(std::abs(m.rung - m.other_rung), 1);
  EXPECT_NEAR(m.value * rung_unit(m.rung), m.other_value() * rung_unit(m.other_rung), 1e-12);
}

TEST(SoftBits, SayTheBitThatTheLatticeHolds) {
  const Dither dither(Key::trial());
  const double step = step_size(8);
  FluxValues values = even_values(60);
  std::array<std::uint8_t, kFunctionals> bits{};
  for (std::size_t i = 0; i < 60; ++i) {
    bits[i] = random_bits(9, 0, i) & 1U;
    const int rung = measured(values)[i].rung;
    values.flux[i] = rung_unit(rung) * step * (3 + dither.of(i, rung) + 0.5 * bits[i]);
  }
  const SoftBits soft = soft_bits(measured(values), same_axes(), dither, step, 4);
  for (std::size_t i = 0; i < 60; ++i) EXPECT_EQ(soft.ratio[i] < 0, bits[i] == 1) << i;
  EXPECT_EQ(soft.ratio[100], 0);
  EXPECT_GT(soft.evidence(bits), 80);
}

// The bound of a false alarm in small: of many unmarked readings, hardly any reach what it says.
TEST(SoftBits, GiveEvidenceByChanceNoOftenerThanItSays) {
  constexpr int kReadings = 10000;
  const FluxValues values = even_values(40);
  const Measurement measurement = measured(values);
  const std::array<std::uint8_t, kFunctionals> word{};
  for (const double sharpness : kSharpness) {
    std::array<int, 9> reached{};  // by bits
    for (int i = 0; i < kReadings; ++i) {
      // a reading under a wrong key is one of other values: each in a random place of its cell
      Measurement other = measurement;
      for (std::size_t f = 0; f < 40; ++f) {
        other[f].value = 10 + 5 * random_unit(17, f, static_cast<std::uint64_t>(i));
      }
      const Dither dither(Key::trial());
      const double bits =
          soft_bits(other, same_axes(), dither, step_size(6), sharpness).evidence(word);
      for (std::size_t least = 0; least < reached.size(); ++least) {
        reached[least] += bits >= static_cast<double>(least) ? 1 : 0;
      }
    }
    for (std::size_t least = 1; least < reached.size(); ++least) {
      const double most = std::ldexp(kReadings, -static_cast<int>(least));
      EXPECT_LE(reached[least], most + 4 * std::sqrt(most)) << least << " bits, " << sharpness;
    }
  }
}

TEST(CosineEvidence, BoundsTheTailOfRandomPhases) {
  constexpr int kSums = 20000;
  constexpr std::size_t kCosines = 30;
  std::vector<double> sums(kSums, 0);
  for (std::size_t i = 0; i < kSums; ++i) {
    for (std::size_t c = 0; c < kCosines; ++c) {
      sums[i] += std::cos(2 * M_PI * random_unit(4, c, i));
    }
  }
  for (const double least : {3.0, 6.0, 9.0, 12.0}) {
    const auto above =
        std::count_if(sums.begin(), sums.end(), [&](double s) { return s >= least; });
    const double bound = kSums * std::exp2(-cosine_evidence(least, kCosines));
    EXPECT_LE(static_cast<double>(above), bound + 4 * std::sqrt(bound)) << least;
    EXPECT_GE(static_cast<double>(above), bound / 30 - 5) << least;  // and is no empty promise
  }
  EXPECT_EQ(cosine_evidence(-1, kCosines), 0);
  EXPECT_GT(cosine_evidence(kCosines, kCosines), 100);
}

}  // namespace
}  // namespace triglyph
