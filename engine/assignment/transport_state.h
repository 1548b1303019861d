// What is known while a transportation problem is solved: who holds what, and the dual values that
// prove it to be least so far.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "engine/assignment/candidates.h"
#include "engine/assignment/transport.h"

namespace triglyph {

inline constexpr std::uint32_t kNobody = 0xffffffff;

// Invariants: value <= cost + price over all pairs of the word, with equality for
// the units it holds; the same for the reserve, whose cost is 0. Values and prices never fall, so
// a list of candidates keeps its bound.
struct TransportWord {
  std::span<const float> column;
  std::uint32_t deficit = 0;     // copies still without unit
  std::uint32_t in_reserve = 0;  // copies that found no unit
  std::size_t width = 0;         // of the list of candidates, at least
  std::size_t first_width = 0;
  double value = 0;
  CandidateList list{};
  std::vector<std::uint32_t> held{};  // units
};

// Units nobody wants are the copies of one more word that costs nothing, unless they are most of
// the units; copies that find no unit go to a reserve that costs nothing. Both sides are then
// served completely and the dual values have no signs to keep.
struct TransportState {
  // Nobody holds anything; values and prices are as good as can be told from single units and
  // words. O(units * words), in parallel.
  explicit TransportState(const TransportProblem& problem);

  // Picks candidates by the prices of now, more of them if that did not raise the bound.
  void renew_list(std::uint32_t word);
  // Picks as many as at first.
  void renew_short_list(std::uint32_t word);
  // Sets the word's value to its best pair, by the prices of now.
  void renew_value(std::uint32_t word);
  // Takes every unit from its owner; prices stay.
  void take_everything_back();
  // Hands the unit to the word, from whoever holds it. Counts of copies are the caller's.
  void give(std::uint32_t unit, std::uint32_t word);

  std::vector<std::uint32_t> names;  // of words in the problem; the unwanted word is kNoWord
  std::vector<TransportWord> words;  // those with copies, the unwanted word last
  std::vector<float> zeros;          // column of the unwanted word; empty without one
  std::vector<double> prices;        // of units; infinite for those left out
  std::vector<std::uint32_t> owner;  // index in words or kNobody
  std::vector<std::uint32_t> place;  // of a unit among its owner's held
  // Most units will be left: no word takes them, they stay free at a price of 0 until they are
  // given away, and then have an owner for good.
  bool is_choice = false;
  std::uint32_t reserve_size = 0;
  std::uint32_t reserve_left = 0;
  double reserve_price = 0;

 private:
  void count_copies(const TransportProblem& problem);
  void set_first_prices(const TransportProblem& problem);
};

}  // namespace triglyph
