// The state of the transportation solver: a partial assignment, and dual values that prove it
// optimal.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "engine/assignment/candidates.h"
#include "engine/assignment/transport.h"

namespace triglyph {

inline constexpr std::uint32_t kNoIndex = 0xffffffff;

// A word with copies to place, and its dual value. Invariants: value <= cost + price for all pairs
// of the word, with equality for the units it holds; likewise for the reserve, whose cost is 0.
// Values and prices never fall, so the bound of a candidate list stays valid.
struct TransportWord {
  std::span<const float> column;
  std::uint32_t deficit = 0;     // copies still to be placed
  std::uint32_t in_reserve = 0;  // copies placed in the reserve
  std::size_t width = 0;         // least length of the next candidate list
  std::size_t first_width = 0;   // of the first one
  double value = 0;
  CandidateList list{};
  std::vector<std::uint32_t> held{};  // units that carry the word
};

// The problem is made balanced, so that dual values need no sign constraints: surplus units carry
// copies of a dummy word of cost 0, and surplus copies of words go to a reserve of cost 0. If most
// units are surplus, there is no dummy word: see `has_optional_units`.
struct TransportState {
  // Starts with no unit assigned, and with values and prices from the minima of rows and columns.
  // O(units * words), parallel.
  explicit TransportState(const TransportProblem& problem);

  // Picks candidates at current prices. If that does not raise the bound, the next list is longer.
  void renew_list(std::uint32_t word);
  // Picks as many candidates as the first time.
  void renew_short_list(std::uint32_t word);
  // Sets the word's value to that of its best pair at current prices.
  void renew_value(std::uint32_t word);
  // Makes every unit free; prices stay.
  void release_all_units();
  // Assigns the unit to the word, taking it from its owner. The caller updates the counts of
  // copies.
  void give(std::uint32_t unit, std::uint32_t word);

  std::vector<std::uint32_t> names;  // of words in the problem; kNoWord for the dummy word
  std::vector<TransportWord> words;  // those with copies, the dummy word last
  std::vector<float> zeros;          // column of the dummy word; empty if there is none
  std::vector<double> prices;        // of units; infinite for excluded ones
  std::vector<std::uint32_t> owner;  // of each unit, as an index in `words`; kNoIndex: free
  std::vector<std::uint32_t> place;  // of each unit among its owner's `held`
  // Most units stay free: they have a price of 0 until they are assigned, and stay assigned then.
  bool has_optional_units = false;
  std::uint32_t reserve_size = 0;
  std::uint32_t reserve_left = 0;  // free places in the reserve
  double reserve_price = 0;

 private:
  void count_copies(const TransportProblem& problem);
  void set_first_prices(const TransportProblem& problem);
};

}  // namespace triglyph
