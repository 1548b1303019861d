// The minimum-cost transportation problem, for the case that one side can be served completely.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/assignment/cost_matrix.h"

namespace triglyph {

struct TransportProblem {
  const CostMatrix& costs;
  std::span<const std::uint32_t> demand;       // copies of each word; 0 excludes the word
  std::span<const std::uint8_t> is_unit_open;  // 0 excludes the unit
};

// Returns the word of every unit, kNoWord if it stays free, with the least sum of costs among the
// assignments that place every copy of every word or, if there are more copies than open units,
// fill every open unit. Precondition: such an assignment exists, else std::logic_error.
// O(units * words) in practice; worst case O(min(copies, units) * units * words).
[[nodiscard]] std::vector<std::uint32_t> solve_transport(const TransportProblem& problem);

}  // namespace triglyph
