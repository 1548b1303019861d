// The transportation problem of least cost, for the case that one side can be served completely.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/assignment/cost_matrix.h"

namespace triglyph {

struct TransportProblem {
  const CostMatrix& costs;
  std::span<const std::uint32_t> demand;       // copies of each word; 0 leaves a word out
  std::span<const std::uint8_t> is_unit_open;  // 0 leaves a unit out
};

// Word of every unit, kNoWord where it stays free, such that the sum of costs is least among the
// answers that serve every copy of every word or, if there are more copies than open units, fill
// every unit. Precondition: such an answer exists, else std::logic_error.
// O(units * words) in practice; worst case O(min(copies, units) * units * words).
[[nodiscard]] std::vector<std::uint32_t> solve_transport(const TransportProblem& problem);

}  // namespace triglyph
