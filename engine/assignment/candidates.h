// The few pairs of a word that can matter, picked from its column of the cost matrix, with a bound
// on all the others.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace triglyph {

struct Candidate {
  std::uint32_t unit;
  float cost;
};

struct CandidateList {
  std::vector<Candidate> pairs;
  double bound = 0;  // every pair left out has cost + price >= bound; infinite if none is left out
};

struct CandidateQuery {
  std::size_t wanted = 16;   // at least so many pairs, if there are as many
  std::uint64_t spread = 0;  // where the search for equally good units starts; any number
};

// The pairs with the least cost + price. A price of +infinity takes a unit out. The list holds
// `wanted` pairs or all there are; more than that by a small factor unless cheap units sit next
// to each other. Precondition: column.size() == prices.size(). O(units), two sweeps.
[[nodiscard]] CandidateList pick_candidates(std::span<const float> column,
                                            std::span<const double> prices,
                                            const CandidateQuery& query);

}  // namespace triglyph
