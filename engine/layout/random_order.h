// Orders of the units, drawn by chance: what randomised greedy solvers are made of.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/layout/conflicts.h"

namespace triglyph {

// Units that interfere with each unit, a neighbour counting once for every shared point, and the
// unit itself too. O(total size of the units' lists of points).
[[nodiscard]] std::vector<std::uint32_t> degrees_of(const Conflicts& conflicts);

// Takes the units in this order, each if it interferes with none taken before. Ascending result.
// O(sum of degrees).
[[nodiscard]] std::vector<std::uint32_t> fit_in_order(const Conflicts& conflicts,
                                                      std::span<const std::uint32_t> order);

// Draws the units without replacement, each with a chance proportional to its attraction among
// those that are left; so taking them in order is a greedy construction that draws its next unit
// among the free ones. `attraction` > 0. O(n log n).
// Efraimidis, Spirakis. Weighted random sampling with a reservoir. Information Processing Letters
// 97 (2006): sorting by exponential keys.
[[nodiscard]] std::vector<std::uint32_t> draw_order(std::span<const double> attraction,
                                                    std::uint64_t seed, std::uint64_t index);

}  // namespace triglyph
