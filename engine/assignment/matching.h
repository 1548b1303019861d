// Matchings over the pairs whose cost is at most a limit, without regard to what they cost.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/assignment/cost_matrix.h"

namespace triglyph {

// The finite pairs with cost <= limit, one bit each: a sweep over the candidates of a word handles
// 64 units at a time, and the whole graph takes 1/32 of the matrix.
class ThresholdGraph {
 public:
  // O(units * words), in parallel.
  ThresholdGraph(const CostMatrix& costs, float limit);

  [[nodiscard]] std::uint32_t units() const { return units_; }
  [[nodiscard]] std::uint32_t words() const { return words_; }
  // Bit unit % 64 of row(word)[unit / 64].
  [[nodiscard]] std::span<const std::uint64_t> row(std::uint32_t word) const {
    return {bits_.data() + word * stride_, stride_};
  }

 private:
  std::uint32_t units_ = 0;
  std::uint32_t words_ = 0;
  std::size_t stride_ = 0;
  std::vector<std::uint64_t> bits_;
};

struct Matching {
  std::vector<std::uint32_t> word_of_unit;  // kNoWord where free
  std::vector<std::uint32_t> unserved;      // copies of each word without a unit
  std::uint32_t matched = 0;
};

[[nodiscard]] Matching empty_matching(std::uint32_t units, std::span<const std::uint32_t> demand);

// Enlarges `start`, whose pairs must all be in the graph, to as many pairs as possible.
// O(E sqrt(V)) bit operations (Hopcroft & Karp 1973).
[[nodiscard]] Matching grow_maximum_matching(const ThresholdGraph& graph, Matching start);

// The part of the graph in which words outnumber units (Dulmage & Mendelsohn 1958): every matching
// of maximum size gives each scarce unit to a scarce word and serves every other word fully.
struct Scarcity {
  std::vector<std::uint8_t> is_scarce_word;
  std::vector<std::uint8_t> is_scarce_unit;
};

// Precondition: `maximum` is a maximum matching of the graph. O(E) bit operations.
[[nodiscard]] Scarcity find_scarcity(const ThresholdGraph& graph, const Matching& maximum);

}  // namespace triglyph
