// This work is based on:
//  - A. L. Dulmage, N. S. Mendelsohn: Coverings of bipartite graphs, 1958. If not every copy of
//    every word can be placed, the problem splits into two: the words that compete for too few
//    units, and all others. In each, one side is served completely. Which copies are left over then
//    follows from the least sum, without a penalty so large that it would swamp the costs.
#include "engine/assignment/least_sum.h"

#include <atomic>
#include <limits>
#include <utility>

#include "engine/assignment/assignment.h"
#include "engine/assignment/transport.h"
#include "engine/base/error.h"
#include "engine/base/parallel.h"

namespace triglyph {
namespace {

std::uint64_t count_copies(std::span<const std::uint32_t> demand) {
  std::uint64_t copies = 0;
  for (const std::uint32_t wanted : demand) copies += wanted;
  return copies;
}

// Returns the costs with those above the limit replaced by infinity.
CostMatrix mask_above(const CostMatrix& costs, float limit) {
  CostMatrix masked{costs.units, costs.words, std::vector<float>(costs.values.size(), kInfeasible)};
  parallel_blocks(costs.values.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (costs.values[i] <= limit) masked.values[i] = costs.values[i];
    }
  });
  return masked;
}

}  // namespace

void check_costs(const CostMatrix& costs, std::span<const std::uint32_t> demand) {
  check(demand.size() == costs.words, "one demand per word");
  check(costs.values.size() == static_cast<std::size_t>(costs.units) * costs.words,
        "one cost per pair");
  std::atomic<bool> is_good = true;
  parallel_for(
      costs.words,
      [&](std::size_t word) {
        bool is_column_good = true;
        for (const float cost : costs.column(static_cast<std::uint32_t>(word))) {
          is_column_good &= cost >= 0;
        }
        if (!is_column_good) is_good = false;
      },
      16);
  check(is_good, "costs are numbers >= 0 or infinite");
}

std::vector<std::uint32_t> minimise_sum(const CostMatrix& costs,
                                        std::span<const std::uint32_t> demand, float limit,
                                        const PairGraph& graph, const Matching& maximum) {
  const bool is_limited = limit < kAllFinite;
  const CostMatrix masked = is_limited ? mask_above(costs, limit) : CostMatrix{};
  const CostMatrix& allowed = is_limited ? masked : costs;
  std::vector<std::uint8_t> all_units(costs.units, 1);
  if (maximum.matched == count_copies(demand)) {
    return solve_transport({allowed, demand, all_units});
  }
  const Scarcity scarcity = find_scarcity(graph, maximum);
  std::vector<std::uint32_t> word_of_unit(costs.units, kNoWord);
  for (const std::uint8_t is_scarce : {std::uint8_t{0}, std::uint8_t{1}}) {
    std::vector<std::uint32_t> part_demand(demand.begin(), demand.end());
    for (std::uint32_t word = 0; word < costs.words; ++word) {
      if (scarcity.is_scarce_word[word] != is_scarce) part_demand[word] = 0;
    }
    std::vector<std::uint8_t> part_units(costs.units);
    for (std::uint32_t unit = 0; unit < costs.units; ++unit) {
      part_units[unit] = scarcity.is_scarce_unit[unit] == is_scarce ? 1 : 0;
    }
    const auto part = solve_transport({allowed, part_demand, part_units});
    for (std::uint32_t unit = 0; unit < costs.units; ++unit) {
      if (part_units[unit] != 0) word_of_unit[unit] = part[unit];
    }
  }
  return word_of_unit;
}

Assignment assign_least_sum(const CostMatrix& costs, std::span<const std::uint32_t> demand) {
  check_costs(costs, demand);
  const PairGraph graph = find_pairs_within(costs, kAllFinite);
  const Matching maximum = grow_maximum_matching(graph, empty_matching(costs.units, demand));
  return evaluate_assignment(costs, minimise_sum(costs, demand, kAllFinite, graph, maximum));
}

}  // namespace triglyph
