// This work is based on:
//  - R. Burkard, M. Dell'Amico, S. Martello: Assignment problems, 2009, chapter 6 (threshold and
//    augmenting path methods for the bottleneck assignment problem).
//  - D. R. Fulkerson, I. Glicksberg, O. Gross: A production line assignment problem, 1953 (bounds
//    from the minima of rows and columns).
// Deviations:
//  1. The threshold starts at a lower bound, which is often the optimum. From a maximum matching
//     there it rises only to the least cost that lets an alternating forest grow. Every rise is
//     necessary, so the last one gives the optimum. Bisection remains for the case that the bound
//     is poor and many units are unmatched.
//  2. A word may have several copies, and not every copy can always be placed.
#include <algorithm>
#include <bit>
#include <limits>
#include <utility>

#include "engine/assignment/assignment.h"
#include "engine/assignment/least_sum.h"
#include "engine/assignment/matching.h"
#include "engine/base/parallel.h"
#include "engine/base/stop.h"

namespace triglyph {
namespace {

// Unmatched units for which growing forests is cheaper than bisection.
constexpr std::uint32_t kFewMissing = 4;

// Returns the least cost of every unit over the words with is_chosen[word] == choice.
std::vector<float> find_unit_minima(const CostMatrix& costs,
                                    std::span<const std::uint8_t> is_chosen, std::uint8_t choice) {
  std::vector<float> minima(costs.units, kInfeasible);
  parallel_blocks(
      costs.units,
      [&](std::size_t begin, std::size_t end) {
        for (std::uint32_t word = 0; word < costs.words; ++word) {
          if (is_chosen[word] != choice) continue;
          const float* column = costs.column(word).data();
          for (std::size_t unit = begin; unit < end; ++unit) {
            minima[unit] = column[unit] < minima[unit] ? column[unit] : minima[unit];
          }
        }
      },
      1024);
  return minima;
}

float nth_smallest(std::vector<float>& values, std::size_t n) {
  const auto nth = values.begin() + static_cast<std::ptrdiff_t>(n);
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

// Returns a lower bound: a scarce unit is always used, so the maximum is at least its cheapest
// scarce word.
float bound_by_scarce_units(const CostMatrix& costs, const Scarcity& scarcity) {
  const std::vector<float> minima = find_unit_minima(costs, scarcity.is_scarce_word, 1);
  float bound = 0;
  for (std::uint32_t unit = 0; unit < costs.units; ++unit) {
    if (scarcity.is_scarce_unit[unit] != 0) bound = std::max(bound, minima[unit]);
  }
  return bound;
}

// Returns a lower bound: all copies of the other words are placed, so a word with d copies takes a
// unit no better than its d-th best, and k copies together take one no better than the k-th best.
float bound_by_served_words(const CostMatrix& costs, std::span<const std::uint32_t> demand,
                            const Scarcity& scarcity) {
  std::vector<float> bounds(costs.words, 0.0F);
  parallel_for(costs.words, [&](std::size_t word) {
    if (scarcity.is_scarce_word[word] != 0 || demand[word] == 0) return;
    const auto column = costs.column(static_cast<std::uint32_t>(word));
    std::vector<float> open;
    float least = kInfeasible;
    for (std::size_t unit = 0; unit < column.size(); ++unit) {
      if (scarcity.is_scarce_unit[unit] != 0) continue;
      least = std::min(least, column[unit]);
      if (demand[word] > 1) open.push_back(column[unit]);
    }
    bounds[word] = demand[word] > 1 ? nth_smallest(open, demand[word] - 1) : least;
  });
  float bound = 0;
  std::size_t copies = 0;
  std::vector<std::uint8_t> is_wanted(costs.words, 0);
  for (std::uint32_t word = 0; word < costs.words; ++word) {
    if (scarcity.is_scarce_word[word] != 0 || demand[word] == 0) continue;
    bound = std::max(bound, bounds[word]);
    is_wanted[word] = 1;
    copies += demand[word];
  }
  if (copies == 0) return bound;
  const std::vector<float> minima = find_unit_minima(costs, is_wanted, 1);
  std::vector<float> open;
  for (std::uint32_t unit = 0; unit < costs.units; ++unit) {
    if (scarcity.is_scarce_unit[unit] == 0) open.push_back(minima[unit]);
  }
  return std::max(bound, nth_smallest(open, copies - 1));
}

float find_lower_bound(const CostMatrix& costs, std::span<const std::uint32_t> demand,
                       const PairGraph& feasible, const Matching& largest) {
  const bool all_served = std::all_of(largest.unserved.begin(), largest.unserved.end(),
                                      [](std::uint32_t copies) { return copies == 0; });
  if (all_served) {
    const Scarcity none{std::vector<std::uint8_t>(costs.words),
                        std::vector<std::uint8_t>(costs.units)};
    return bound_by_served_words(costs, demand, none);
  }
  const Scarcity scarcity = find_scarcity(feasible, largest);
  return std::max(bound_by_scarce_units(costs, scarcity),
                  bound_by_served_words(costs, demand, scarcity));
}

float find_maximum(const CostMatrix& costs, const Matching& matching) {
  float maximum = 0;
  for (std::uint32_t unit = 0; unit < costs.units; ++unit) {
    const std::uint32_t word = matching.word_of_unit[unit];
    if (word != kNoWord) maximum = std::max(maximum, costs.at(unit, word));
  }
  return maximum;
}

struct Threshold {
  float value = 0;    // lower bound of the maximum of any matching of the wanted size
  Matching matching;  // a maximum matching at that value
};

// Bisects the interval of possible thresholds, in the order of the floats' bit patterns, until only
// a few units are unmatched at the lower end.
Threshold bisect_threshold(const CostMatrix& costs, Threshold lower, float upper,
                           std::uint32_t wanted) {
  // The bit patterns of floats >= 0 are ordered like the floats.
  auto low = std::bit_cast<std::uint32_t>(lower.value);
  auto high = std::bit_cast<std::uint32_t>(upper);
  while (wanted - lower.matching.matched > kFewMissing && high - low > 1) {
    const std::uint32_t middle = low + (high - low) / 2;
    const auto value = std::bit_cast<float>(middle);
    Matching matching = grow_maximum_matching(find_pairs_within(costs, value), lower.matching);
    if (matching.matched == wanted) {
      high = std::bit_cast<std::uint32_t>(find_maximum(costs, matching));
    } else {
      low = middle;
      lower = {value, std::move(matching)};
    }
  }
  return lower;
}

// An alternating forest that is rooted at the unserved copies and grows over pairs within the
// threshold. When no pair is left it raises the threshold to the least cost of a pair that leaves
// the forest.
class Forest {
 public:
  Forest(const CostMatrix& costs, Threshold& threshold)
      : costs_(costs),
        threshold_(threshold),
        slack_(costs.units, kInfeasible),
        cheapest_(costs.units, kNoWord),
        word_is_in_(costs.words, 0),
        unit_of_word_(costs.words, 0) {}

  // Enlarges the matching by one pair. Returns false if no augmenting path exists.
  bool augment() {
    for (std::uint32_t word = 0; word < costs_.words; ++word) {
      if (threshold_.matching.unserved[word] > 0) add_word(word);
    }
    for (;;) {
      stop_point();
      float least = kInfeasible;
      for (const float slack : slack_) least = slack >= 0 && slack < least ? slack : least;
      if (least == kInfeasible) return false;
      threshold_.value = std::max(threshold_.value, least);
      for (std::uint32_t unit = 0; unit < costs_.units; ++unit) {
        if (slack_[unit] < 0 || slack_[unit] > threshold_.value) continue;
        slack_[unit] = kIsIn;
        const std::uint32_t owner = threshold_.matching.word_of_unit[unit];
        if (owner == kNoWord) {
          shift_path(unit);
          return true;
        }
        if (word_is_in_[owner] != 0) continue;
        unit_of_word_[owner] = unit;
        add_word(owner);
      }
    }
  }

 private:
  static constexpr float kIsIn = -1;  // slack of a unit in the forest: below every cost

  void add_word(std::uint32_t word) {
    stop_point();
    word_is_in_[word] = 1;
    const float* column = costs_.column(word).data();
    for (std::uint32_t unit = 0; unit < costs_.units; ++unit) {
      const bool is_less = column[unit] < slack_[unit];
      slack_[unit] = is_less ? column[unit] : slack_[unit];
      cheapest_[unit] = is_less ? word : cheapest_[unit];
    }
  }

  void shift_path(std::uint32_t free_unit) {
    std::uint32_t unit = free_unit;
    std::uint32_t word = cheapest_[unit];
    Matching& matching = threshold_.matching;
    while (matching.unserved[word] == 0) {
      matching.word_of_unit[unit] = word;
      unit = unit_of_word_[word];
      word = cheapest_[unit];
    }
    matching.word_of_unit[unit] = word;
    --matching.unserved[word];
    ++matching.matched;
  }

  const CostMatrix& costs_;
  Threshold& threshold_;
  std::vector<float> slack_;             // least cost of a unit with a word of the forest; kIsIn
  std::vector<std::uint32_t> cheapest_;  // that word
  std::vector<std::uint8_t> word_is_in_;
  std::vector<std::uint32_t> unit_of_word_;  // through which a word joined the forest
};

}  // namespace

Assignment assign_bottleneck(const CostMatrix& costs, std::span<const std::uint32_t> demand) {
  check_costs(costs, demand);
  const PairGraph feasible = find_pairs_within(costs, kAllFinite);
  const Matching largest = grow_maximum_matching(feasible, empty_matching(costs.units, demand));
  Threshold threshold{find_lower_bound(costs, demand, feasible, largest), {}};
  const PairGraph at_bound = find_pairs_within(costs, threshold.value);
  threshold.matching = grow_maximum_matching(at_bound, empty_matching(costs.units, demand));
  if (threshold.matching.matched < largest.matched) {
    threshold = bisect_threshold(costs, std::move(threshold), find_maximum(costs, largest),
                                 largest.matched);
    while (threshold.matching.matched < largest.matched) Forest(costs, threshold).augment();
  }
  const PairGraph graph = find_pairs_within(costs, threshold.value);
  return evaluate_assignment(
      costs, minimise_sum(costs, demand, threshold.value, graph, threshold.matching));
}

}  // namespace triglyph
