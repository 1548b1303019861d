#include "engine/assignment/transport_state.h"

#include <algorithm>
#include <limits>

#include "engine/assignment/assignment.h"
#include "engine/base/error.h"
#include "engine/base/parallel.h"
#include "engine/base/random.h"

namespace triglyph {
namespace {

// Candidates beyond a word's copies, so that its bids find a next best unit.
constexpr std::size_t kSpareCandidates = 16;
// Units per copy from which the surplus units stay free instead of carrying a dummy word, whose
// list would hold most of them.
constexpr std::uint64_t kMinUnitsPerCopy = 2;

}  // namespace

TransportState::TransportState(const TransportProblem& problem) {
  owner.assign(problem.costs.units, kNoIndex);
  place.assign(problem.costs.units, 0);
  count_copies(problem);
  set_first_prices(problem);
  parallel_for(
      words.size(), [&](std::size_t k) { renew_value(static_cast<std::uint32_t>(k)); }, 4);
}

void TransportState::renew_value(std::uint32_t word) {
  TransportWord& w = words[word];
  renew_short_list(word);
  w.value = kInfinity;
  if (reserve_size > 0) w.value = reserve_price;
  for (const Candidate& pair : w.list.pairs) {
    w.value = std::min(w.value, double{pair.cost} + prices[pair.unit]);
  }
}

void TransportState::release_all_units() {
  for (TransportWord& word : words) {
    word.deficit += static_cast<std::uint32_t>(word.held.size());
    word.held.clear();
  }
  std::fill(owner.begin(), owner.end(), kNoIndex);
}

void TransportState::count_copies(const TransportProblem& problem) {
  std::uint64_t open = 0;
  for (const std::uint8_t is_open : problem.is_unit_open) open += is_open != 0;
  std::uint64_t copies = 0;
  for (std::uint32_t name = 0; name < problem.costs.words; ++name) {
    // More copies than units are never placed; leaving them out keeps the counts small.
    const auto wanted =
        static_cast<std::uint32_t>(std::min<std::uint64_t>(problem.demand[name], open));
    if (wanted == 0) continue;
    names.push_back(name);
    words.push_back({problem.costs.column(name), wanted});
    copies += wanted;
  }
  if (copies > open) {
    check(copies - open < kNoIndex, "surplus copies are counted in 32 bits");
    reserve_size = reserve_left = static_cast<std::uint32_t>(copies - open);
  }
  has_optional_units = copies * kMinUnitsPerCopy <= open;
  if (copies < open && !has_optional_units) {
    zeros.assign(problem.costs.units, 0.0F);
    names.push_back(kNoWord);
    words.push_back({zeros, static_cast<std::uint32_t>(open - copies)});
  }
  for (TransportWord& word : words) {
    word.first_width = word.width = word.deficit + word.deficit / 4 + kSpareCandidates;
  }
}

// A unit's price starts at minus its cheapest cost, so that a unit that is expensive under every
// word competes like any other. With surplus units this applies only to the cheapest, as many as
// there are copies; the dummy word takes the others.
void TransportState::set_first_prices(const TransportProblem& problem) {
  if (has_optional_units) {
    prices.assign(problem.costs.units, kInfinity);
    for (std::size_t unit = 0; unit < prices.size(); ++unit) {
      if (problem.is_unit_open[unit] != 0) prices[unit] = 0;
    }
    return;
  }
  std::vector<float> least(problem.costs.units, std::numeric_limits<float>::infinity());
  const std::size_t wanted_words = words.size() - (zeros.empty() ? 0 : 1);
  parallel_blocks(
      least.size(),
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = 0; k < wanted_words; ++k) {
          const float* column = words[k].column.data();
          for (std::size_t unit = begin; unit < end; ++unit) {
            least[unit] = column[unit] < least[unit] ? column[unit] : least[unit];
          }
        }
      },
      1024);
  float highest = std::numeric_limits<float>::max();
  if (!zeros.empty()) {
    std::vector<float> ordered;
    for (std::size_t unit = 0; unit < least.size(); ++unit) {
      if (problem.is_unit_open[unit] != 0) ordered.push_back(least[unit]);
    }
    const auto nth = ordered.end() - words.back().deficit;
    std::nth_element(ordered.begin(), nth, ordered.end());
    highest = std::min(highest, *nth);
  }
  prices.assign(least.size(), kInfinity);
  for (std::size_t unit = 0; unit < least.size(); ++unit) {
    if (problem.is_unit_open[unit] == 0) continue;
    prices[unit] = -static_cast<double>(std::min(least[unit], highest));
  }
}

void TransportState::renew_list(std::uint32_t word) {
  TransportWord& w = words[word];
  const double old_bound = w.list.pairs.empty() ? -kInfinity : w.list.bound;
  w.list = pick_candidates(w.column, prices, {w.width, mix_bits(word)});
  // Many units tie: list more of them the next time.
  if (w.list.bound <= old_bound) w.width *= 2;
}

void TransportState::renew_short_list(std::uint32_t word) {
  TransportWord& w = words[word];
  w.width = w.first_width;
  w.list = pick_candidates(w.column, prices, {w.width, mix_bits(word)});
}

void TransportState::give(std::uint32_t unit, std::uint32_t word) {
  const std::uint32_t before = owner[unit];
  if (before != kNoIndex) {
    std::vector<std::uint32_t>& held = words[before].held;
    held[place[unit]] = held.back();
    place[held.back()] = place[unit];
    held.pop_back();
  }
  owner[unit] = word;
  place[unit] = static_cast<std::uint32_t>(words[word].held.size());
  words[word].held.push_back(unit);
}

}  // namespace triglyph
