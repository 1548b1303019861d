// Which word goes into which unit. Word j is wanted demand[j] times and a unit holds one word; the
// demands together may be fewer than the units (the cheapest are used), as many, or more (as many
// words as possible are served).
//
// For all three: precondition demand.size() == costs.words and no cost is negative or NaN, else
// std::logic_error. An infinite pair is never used. The result is the same for any number of
// threads; where several answers are equally good, which of them is returned depends on the input
// alone and is not otherwise promised.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/assignment/cost_matrix.h"

namespace triglyph {

inline constexpr std::uint32_t kNoWord = 0xffffffff;

struct Assignment {
  std::vector<std::uint32_t> word_of_unit;  // kNoWord where the unit is not used
  std::uint32_t matched = 0;                // units used
  double max_cost = 0;                      // over the units used; 0 without any
  double sum_cost = 0;                      // added in order of the units

  bool operator==(const Assignment&) const = default;
};

// No optimisation: unit i gets the i-th word in rounds 0, 1, .. over the words, leaving out those
// whose demand is used up. A unit that cannot hold its word stays empty and that copy of the word
// is lost, as in figure 1 of Wang & Hu 2010. O(units + words).
[[nodiscard]] Assignment assign_sequential(const CostMatrix& costs,
                                           std::span<const std::uint32_t> demand);

// As many units as possible, among those answers the least maximum, among those the least sum:
// Wang & Hu 2010, equation 3. The sum is least up to the rounding of double arithmetic (exact for
// costs that are integers); number of units and maximum are always exact.
// O(units * words) a sweep, a handful of sweeps in practice. note: worst case cubic, reached where
// costs are a product of a unit's and a word's factor, or nearly tie across most words.
[[nodiscard]] Assignment assign_bottleneck(const CostMatrix& costs,
                                           std::span<const std::uint32_t> demand);

// As many units as possible, among those answers the least sum: Wang & Hu 2010, equation 2.
// Exactness and cost as for assign_bottleneck.
[[nodiscard]] Assignment assign_least_sum(const CostMatrix& costs,
                                          std::span<const std::uint32_t> demand);

// Counts and adds up what word_of_unit uses. Precondition: no pair used is infinite. O(units).
[[nodiscard]] Assignment weigh_assignment(const CostMatrix& costs,
                                          std::vector<std::uint32_t> word_of_unit);

}  // namespace triglyph
