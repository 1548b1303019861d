// The maximum matching of least sum of costs among pairs within a limit, the second stage of both
// optimal assignments.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/assignment/cost_matrix.h"
#include "engine/assignment/matching.h"

namespace triglyph {

// Returns the word of every unit, kNoWord if it stays free, for a matching of least sum with as
// many pairs as `maximum`. Preconditions: `graph` holds the pairs with cost <= limit, `maximum` is
// a maximum matching of it, and the limit is finite. Complexity as for solve_transport().
[[nodiscard]] std::vector<std::uint32_t> minimise_sum(const CostMatrix& costs,
                                                      std::span<const std::uint32_t> demand,
                                                      float limit, const PairGraph& graph,
                                                      const Matching& maximum);

// Throws std::logic_error if sizes do not match, or if a cost is negative or NaN. O(units * words),
// parallel.
void check_costs(const CostMatrix& costs, std::span<const std::uint32_t> demand);

}  // namespace triglyph
