// This work is based on:
//  - Y.-P. Wang, S.-M. Hu: Optimization approach for 3D model watermarking by linear binary
//    programming, CAGD 27 (2010): the un-optimised order of figure 1.
#include "engine/assignment/assignment.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/base/error.h"

namespace triglyph {

Assignment evaluate_assignment(const CostMatrix& costs, std::vector<std::uint32_t> word_of_unit) {
  check(word_of_unit.size() == costs.units, "one word per unit");
  Assignment result;
  for (std::uint32_t unit = 0; unit < costs.units; ++unit) {
    if (word_of_unit[unit] == kNoWord) continue;
    const double cost = costs.at(unit, word_of_unit[unit]);
    check(std::isfinite(cost), "an infeasible pair is never used");
    ++result.matched;
    result.max_cost = std::max(result.max_cost, cost);
    result.sum_cost += cost;
  }
  result.word_of_unit = std::move(word_of_unit);
  return result;
}

Assignment assign_sequential(const CostMatrix& costs, std::span<const std::uint32_t> demand) {
  check(demand.size() == costs.words, "one demand per word");
  check(costs.values.size() == static_cast<std::size_t>(costs.units) * costs.words,
        "one cost per pair");
  std::vector<std::uint32_t> word_of_unit(costs.units, kNoWord);
  std::vector<std::uint32_t> round;  // words with demand left in this round
  for (std::uint32_t word = 0; word < costs.words; ++word) {
    if (demand[word] > 0) round.push_back(word);
  }
  std::uint32_t unit = 0;
  for (std::uint32_t rounds_done = 0; !round.empty() && unit < costs.units; ++rounds_done) {
    for (std::size_t k = 0; k < round.size() && unit < costs.units; ++k, ++unit) {
      if (std::isfinite(costs.at(unit, round[k]))) word_of_unit[unit] = round[k];
    }
    std::erase_if(round, [&](std::uint32_t word) { return demand[word] <= rounds_done + 1; });
  }
  return evaluate_assignment(costs, std::move(word_of_unit));
}

}  // namespace triglyph
