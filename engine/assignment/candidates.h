// Candidate lists: the cheapest pairs of a word, with a lower bound on all its other pairs.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace triglyph {

// The price of a unit that is excluded, and the bound of an exhaustive list.
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Candidate {
  std::uint32_t unit;
  float cost;
};

struct CandidateList {
  std::vector<Candidate> pairs;
  double bound = 0;  // all other pairs have cost + price >= bound; infinite if there are none
};

struct CandidateQuery {
  std::size_t wanted = 16;   // least number of pairs to list
  std::uint64_t spread = 0;  // selects where the search among tied units starts; any number
};

// Returns the pairs with the least cost + price: at least `wanted` or all there are, and up to a
// small factor more unless cheap units are adjacent. A price of +infinity excludes a unit.
// Precondition: column.size() == prices.size(). O(units), two sweeps.
[[nodiscard]] CandidateList pick_candidates(std::span<const float> column,
                                            std::span<const double> prices,
                                            const CandidateQuery& query);

}  // namespace triglyph
