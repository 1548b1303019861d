// Random orders of the units, for randomised greedy solvers.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/layout/conflicts.h"

namespace triglyph {

// Returns the degree of every unit; a neighbour counts once for every shared point, and so does the
// unit itself. O(total size of the units' lists of points).
[[nodiscard]] std::vector<std::uint32_t> degrees_of(const Conflicts& conflicts);

// Returns the units, ascending, that a first fit takes in this order: each that does not interfere
// with one taken before. O(sum of degrees).
[[nodiscard]] std::vector<std::uint32_t> fit_in_order(const Conflicts& conflicts,
                                                      std::span<const std::uint32_t> order);

// Returns a random order of the units: each is drawn without replacement, with a probability
// proportional to its attraction among those that are left. A first fit in this order is therefore
// a randomised greedy construction. Precondition: every attraction is > 0. O(n log n).
// Efraimidis, Spirakis. Weighted random sampling with a reservoir. Information Processing Letters
// 97 (2006): sorting by exponential keys.
[[nodiscard]] std::vector<std::uint32_t> draw_order(std::span<const double> attraction,
                                                    std::uint64_t seed, std::uint64_t index);

}  // namespace triglyph
