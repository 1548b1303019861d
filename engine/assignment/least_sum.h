// The least sum among the matchings of maximum size within a limit; the second half of both
// optimal assignments.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/assignment/cost_matrix.h"
#include "engine/assignment/matching.h"

namespace triglyph {

// Word of every unit for as many pairs as `maximum` has, of least sum. Preconditions: `graph` holds
// the pairs with cost <= limit, `maximum` is a maximum matching of it, limit is finite.
[[nodiscard]] std::vector<std::uint32_t> minimise_sum(const CostMatrix& costs,
                                                      std::span<const std::uint32_t> demand,
                                                      float limit, const PairGraph& graph,
                                                      const Matching& maximum);

// Throws std::logic_error where the sizes do not fit or a cost is negative or NaN.
void check_costs(const CostMatrix& costs, std::span<const std::uint32_t> demand);

}  // namespace triglyph
