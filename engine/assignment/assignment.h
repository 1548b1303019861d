// Assignment of watermark words to invariant units. A unit holds one word, and word j is to be
// placed demand[j] times. The total demand may be less than the number of units (the cheapest units
// are used), equal to it, or more (as many copies as possible are placed).
//
// All three solvers require demand.size() == costs.words and costs that are neither negative nor
// NaN, and throw std::logic_error otherwise. They never use a pair of infinite cost. The result is
// the same for any number of threads; among equally good assignments it depends on the input alone,
// in an unspecified way.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/assignment/cost_matrix.h"

namespace triglyph {

inline constexpr std::uint32_t kNoWord = 0xffffffff;

struct Assignment {
  std::vector<std::uint32_t> word_of_unit;  // kNoWord where the unit is not used
  std::uint32_t matched = 0;                // number of units used
  double max_cost = 0;                      // over the units used; 0 if there are none
  double sum_cost = 0;                      // summed in the order of the units

  bool operator==(const Assignment&) const = default;
};

// Assigns words without optimisation: unit i gets the i-th word of a sequence that cycles through
// the words and leaves out those whose demand is met. A unit that cannot hold its word stays empty,
// and that copy of the word is lost. Wang & Hu 2010, figure 1. O(units + words).
[[nodiscard]] Assignment assign_sequential(const CostMatrix& costs,
                                           std::span<const std::uint32_t> demand);

// Solves the bottleneck assignment: uses as many units as possible, with the least maximum cost,
// and among those the least sum of costs. Number of units and maximum are exact; the sum is least
// up to rounding, and exact for integer costs. Wang & Hu 2010, equation 3.
// O(units * words) per sweep, with a few sweeps in practice.
// note: the worst case is cubic; it occurs if costs are products of a unit's and a word's factor,
// or nearly tie across most words.
[[nodiscard]] Assignment assign_bottleneck(const CostMatrix& costs,
                                           std::span<const std::uint32_t> demand);

// Solves the linear assignment: uses as many units as possible, with the least sum of costs.
// Exactness and complexity as for assign_bottleneck(). Wang & Hu 2010, equation 2.
[[nodiscard]] Assignment assign_least_sum(const CostMatrix& costs,
                                          std::span<const std::uint32_t> demand);

// Returns the assignment that `word_of_unit` describes, with its costs. Precondition: it uses no
// pair of infinite cost. O(units).
[[nodiscard]] Assignment evaluate_assignment(const CostMatrix& costs,
                                             std::vector<std::uint32_t> word_of_unit);

}  // namespace triglyph
