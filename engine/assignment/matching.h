// Maximum matchings over the pairs whose cost is within a limit, regardless of the costs
// themselves.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "engine/assignment/cost_matrix.h"

namespace triglyph {

// A set of (unit, word) pairs as a bit matrix. A sweep over the units of a word handles 64 at a
// time, and the matrix takes 1/32 of the memory of the costs.
class PairGraph {
 public:
  // Starts with no pairs.
  PairGraph(std::uint32_t units, std::uint32_t words)
      : units_(units),
        words_(words),
        stride_((static_cast<std::size_t>(units) + 63) / 64),
        bits_(stride_ * words) {}

  [[nodiscard]] std::uint32_t units() const { return units_; }
  [[nodiscard]] std::uint32_t words() const { return words_; }
  // Returns the units of a word: bit unit % 64 of element unit / 64.
  [[nodiscard]] std::span<const std::uint64_t> row(std::uint32_t word) const {
    return {bits_.data() + word * stride_, stride_};
  }
  // Sets the row of a word to the units for which has(unit) is true. Safe to call from several
  // threads for different words.
  template <typename Has>
  void set_row(std::uint32_t word, const Has& has) {
    std::uint64_t* row = bits_.data() + word * stride_;
    for (std::size_t begin = 0; begin < units_; begin += 64) {
      const std::size_t count = std::min<std::size_t>(64, units_ - begin);
      std::uint64_t bits = 0;
      for (std::size_t k = 0; k < count; ++k) {
        bits |= static_cast<std::uint64_t>(has(begin + k)) << k;
      }
      row[begin / 64] = bits;
    }
  }

 private:
  std::uint32_t units_ = 0;
  std::uint32_t words_ = 0;
  std::size_t stride_ = 0;
  std::vector<std::uint64_t> bits_;
};

// The limit that admits every finite cost.
inline constexpr float kAllFinite = std::numeric_limits<float>::max();

// Returns the pairs with finite cost <= limit. O(units * words), parallel.
[[nodiscard]] PairGraph find_pairs_within(const CostMatrix& costs, float limit);

struct Matching {
  std::vector<std::uint32_t> word_of_unit;  // kNoWord if free
  std::vector<std::uint32_t> unserved;      // copies of each word that have no unit
  std::uint32_t matched = 0;                // number of pairs
};

// Returns the matching without pairs.
[[nodiscard]] Matching empty_matching(std::uint32_t units, std::span<const std::uint32_t> demand);

// Returns a maximum matching of the graph, grown from `start`. Precondition: the pairs of `start`
// are in the graph. O(E sqrt(V)) bit operations (Hopcroft & Karp 1973).
[[nodiscard]] Matching grow_maximum_matching(const PairGraph& graph, Matching start);

// The overdetermined part of the Dulmage-Mendelsohn decomposition (1958): the words that compete
// for too few units. Every maximum matching gives each scarce unit to a scarce word and places all
// copies of every other word.
struct Scarcity {
  std::vector<std::uint8_t> is_scarce_word;
  std::vector<std::uint8_t> is_scarce_unit;
};

// Returns the scarce words and units. Precondition: `maximum` is a maximum matching of the graph.
// O(E) bit operations.
[[nodiscard]] Scarcity find_scarcity(const PairGraph& graph, const Matching& maximum);

}  // namespace triglyph
