// Matchings over the pairs whose cost is at most a limit, without regard to what they cost.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/assignment/cost_matrix.h"

namespace triglyph {

// A set of pairs, one bit each: a sweep over the units of a word handles 64 at a time, and all of
// it takes 1/32 of the matrix.
class PairGraph {
 public:
  // Without any pair.
  PairGraph(std::uint32_t units, std::uint32_t words)
      : units_(units),
        words_(words),
        stride_((static_cast<std::size_t>(units) + 63) / 64),
        bits_(stride_ * words) {}

  [[nodiscard]] std::uint32_t units() const { return units_; }
  [[nodiscard]] std::uint32_t words() const { return words_; }
  // Bit unit % 64 of row(word)[unit / 64].
  [[nodiscard]] std::span<const std::uint64_t> row(std::uint32_t word) const {
    return {bits_.data() + word * stride_, stride_};
  }
  // Makes the row of a word hold the units for which has(unit) is true. Safe to call for several
  // words at a time.
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

// The finite pairs with cost <= limit. O(units * words), in parallel.
[[nodiscard]] PairGraph find_pairs_within(const CostMatrix& costs, float limit);

struct Matching {
  std::vector<std::uint32_t> word_of_unit;  // kNoWord where free
  std::vector<std::uint32_t> unserved;      // copies of each word without a unit
  std::uint32_t matched = 0;
};

[[nodiscard]] Matching empty_matching(std::uint32_t units, std::span<const std::uint32_t> demand);

// Enlarges `start`, whose pairs must all be in the graph, to as many pairs as possible.
// O(E sqrt(V)) bit operations (Hopcroft & Karp 1973).
[[nodiscard]] Matching grow_maximum_matching(const PairGraph& graph, Matching start);

// The part of the graph in which words outnumber units (Dulmage & Mendelsohn 1958): every matching
// of maximum size gives each scarce unit to a scarce word and serves every other word fully.
struct Scarcity {
  std::vector<std::uint8_t> is_scarce_word;
  std::vector<std::uint8_t> is_scarce_unit;
};

// Precondition: `maximum` is a maximum matching of the graph. O(E) bit operations.
[[nodiscard]] Scarcity find_scarcity(const PairGraph& graph, const Matching& maximum);

}  // namespace triglyph
