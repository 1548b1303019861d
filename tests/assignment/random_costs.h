// Cost matrices to solve in tests, as functions of a seed.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "engine/assignment/cost_matrix.h"
#include "engine/base/random.h"

namespace triglyph {

inline constexpr float kImpossible = std::numeric_limits<float>::infinity();

enum class CostKind {
  SmallIntegers,     // 0 .. 3: ties everywhere
  Integers,          // 0 .. 999
  MostlyImpossible,  // integers, two pairs in three infinite
  AllEqual,
  OneHotUnit,  // integers, one unit far more expensive than the others for every word
  Separable,   // max(a_i, b_ij, d_ij) of integers with heavy-tailed a_i, as the schemes produce
  Real,        // uniform in [0, 1)
};

inline constexpr CostKind kCostKinds[] = {
    CostKind::SmallIntegers, CostKind::Integers,   CostKind::MostlyImpossible,
    CostKind::AllEqual,      CostKind::OneHotUnit, CostKind::Separable,
    CostKind::Real};

inline CostMatrix make_costs(CostKind kind, std::uint32_t units, std::uint32_t words,
                             std::uint64_t seed) {
  CostMatrix costs{units, words, {}};
  costs.values.reserve(static_cast<std::size_t>(units) * words);
  for (std::uint32_t word = 0; word < words; ++word) {
    for (std::uint32_t unit = 0; unit < units; ++unit) {
      const std::uint64_t pair = static_cast<std::uint64_t>(unit) << 32 | word;
      const double draw = random_unit(seed, 1, pair);
      double cost = std::floor(1000 * draw);
      if (kind == CostKind::SmallIntegers) cost = std::floor(4 * draw);
      if (kind == CostKind::MostlyImpossible && random_bits(seed, 2, pair) % 3 != 0) {
        cost = kImpossible;
      }
      if (kind == CostKind::AllEqual) cost = 7;
      if (kind == CostKind::OneHotUnit && unit == units / 2) cost += 100000;
      if (kind == CostKind::Separable) {
        const double alone = 20 / (0.01 + random_unit(seed, 3, unit));
        const double split =
            400 * random_unit(seed, 4, static_cast<std::uint64_t>(unit) << 8 | word % 8);
        cost = std::floor(std::max({alone, split, 500 * draw}));
      }
      if (kind == CostKind::Real) cost = draw;
      costs.values.push_back(static_cast<float>(cost));
    }
  }
  return costs;
}

// Demands that add up to about `total`, some of them 0 where there are several words.
inline std::vector<std::uint32_t> make_demand(std::uint32_t words, std::uint32_t total,
                                              std::uint64_t seed) {
  std::vector<std::uint32_t> demand(words, 0);
  for (std::uint32_t copy = 0; words > 0 && copy < total; ++copy) {
    ++demand[random_bits(seed, 5, copy) % words];
  }
  return demand;
}

}  // namespace triglyph
