// This work is based on:
//  - E. W. Dijkstra: A note on two problems in connexion with graphs, 1959.
//  - R. Jonker, A. Volgenant: A shortest augmenting path algorithm for dense and sparse linear
//    assignment problems, 1987 (the search runs over reduced costs).
// Deviation: the nodes are words, not units. All units that a word holds have the distance of the
// word, so the size of the search depends on the number of words and not on that of units.
#include "engine/assignment/path_search.h"

#include <algorithm>
#include <numeric>

#include "engine/base/error.h"
#include "engine/base/stop.h"

namespace triglyph {
namespace {

constexpr std::size_t kManyOpen = 8;  // renewing a list costs about as much as scanning n / 8 units
// Multiple of its first width from which on a list is not renewed: scanning the open units costs
// less.
constexpr std::size_t kLongList = 32;

}  // namespace

PathSearch::PathSearch(TransportState& state)
    : state_(state),
      reach_(state.words.size()),
      is_visited_(state.words.size()),
      open_count_(state.owner.size()) {}

bool PathSearch::is_closed(std::uint32_t unit) const {
  const std::uint32_t owner = state_.owner[unit];
  return owner != kNoIndex ? is_visited_[owner] != 0 : state_.prices[unit] == kFar;
}

void PathSearch::push(double distance, std::uint32_t code) {
  heap_.push_back({distance, code});
  std::push_heap(heap_.begin(), heap_.end());
}

void PathSearch::reach(std::uint32_t word, double distance, std::uint32_t from,
                       std::uint32_t through) {
  if (reach_[word].distance == kFar) reached_.push_back(word);
  reach_[word] = {distance, from, through};
  push(distance, word);
}

void PathSearch::follow(std::uint32_t word, std::uint32_t unit, double distance) {
  if (distance >= end_.distance) return;
  const std::uint32_t owner = state_.owner[unit];
  if (owner == kNoIndex) {
    end_ = {distance, word, unit};
  } else if (distance < reach_[owner].distance) {
    reach(owner, distance, word, unit);
  }
}

// Relaxes the edges of a word: to the words that hold its candidates, to free units, to the
// reserve.
void PathSearch::visit(std::uint32_t word) {
  ++visits_;
  const TransportWord& w = state_.words[word];
  const double distance = reach_[word].distance;
  const double base = distance - w.value;
  for (const Candidate& pair : w.list.pairs) {
    follow(word, pair.unit, std::max(distance, base + (pair.cost + state_.prices[pair.unit])));
  }
  const double renewal = std::max(distance, base + w.list.bound);
  if (renewal < end_.distance) {
    push(renewal, static_cast<std::uint32_t>(state_.words.size()) + word);
  }
  if (state_.reserve_size == 0) return;
  const double next = std::max(distance, base + state_.reserve_price);
  if (state_.reserve_left > 0 && next < end_.distance) end_ = {next, word, kNoIndex};
  if (state_.reserve_left == 0 && next < reserve_reach_.distance) {
    reserve_reach_ = {next, word, kNoIndex};
    push(next, static_cast<std::uint32_t>(2 * state_.words.size()));
  }
}

// Continues beyond the candidate list of a word. A renewed list serves later searches too; but if
// most words are visited, or the list is long already, scanning the units of unvisited words costs
// less.
void PathSearch::visit_beyond_list(std::uint32_t word) {
  const bool has_many_open = open_count_ * kManyOpen > state_.owner.size();
  if (has_many_open && state_.words[word].width < kLongList * state_.words[word].first_width) {
    state_.renew_list(word);
    visit(word);
    return;
  }
  if (!is_open_listed_) {
    open_units_.resize(state_.owner.size());
    std::iota(open_units_.begin(), open_units_.end(), 0U);
    is_open_listed_ = true;
  }
  const double distance = reach_[word].distance;
  const double base = distance - state_.words[word].value;
  const float* column = state_.words[word].column.data();
  std::size_t kept = 0;
  for (const std::uint32_t unit : open_units_) {
    if (is_closed(unit)) continue;
    open_units_[kept++] = unit;
    follow(word, unit, std::max(distance, base + (column[unit] + state_.prices[unit])));
  }
  open_units_.resize(kept);
}

void PathSearch::visit_reserve() {
  for (std::uint32_t word = 0; word < state_.words.size(); ++word) {
    if (state_.words[word].in_reserve > 0 && reserve_reach_.distance < reach_[word].distance) {
      reach(word, reserve_reach_.distance, reserve_reach_.from, kNoIndex);
    }
  }
}

// Dijkstra's algorithm over reduced costs, from a word with a copy to place.
void PathSearch::serve(std::uint32_t source) {
  const auto count = static_cast<std::uint32_t>(state_.words.size());
  reach(source, 0, kNoIndex, kNoIndex);
  while (!heap_.empty()) {
    stop_point();
    std::pop_heap(heap_.begin(), heap_.end());
    const Event event = heap_.back();
    heap_.pop_back();
    if (event.distance >= end_.distance) break;
    if (event.code == 2 * count) {
      if (!is_reserve_visited_) visit_reserve();
      is_reserve_visited_ = true;
    } else if (event.code >= count) {
      visit_beyond_list(event.code - count);
    } else if (is_visited_[event.code] == 0) {
      is_visited_[event.code] = 1;
      open_count_ -= state_.words[event.code].held.size();
      visit(event.code);
    }
  }
  check(end_.distance < kFar, "one side can be served completely");
  raise_values();
  shift_along_path(source);
  forget();
}

// Updates the dual values: the pairs of the path become tight, and all others stay feasible.
void PathSearch::raise_values() {
  for (const std::uint32_t word : reached_) {
    const double rise = end_.distance - reach_[word].distance;
    if (is_visited_[word] == 0 || rise <= 0) continue;
    state_.words[word].value += rise;
    for (const std::uint32_t unit : state_.words[word].held) state_.prices[unit] += rise;
  }
  if (is_reserve_visited_) state_.reserve_price += end_.distance - reserve_reach_.distance;
}

void PathSearch::shift_along_path(std::uint32_t source) {
  for (Reach step = end_;; step = reach_[step.from]) {
    // The word gets the unit that its successor on the path gives up, or a free one.
    if (step.through != kNoIndex) {
      state_.give(step.through, step.from);
    } else {
      ++state_.words[step.from].in_reserve;
    }
    if (step.from == source) break;
    if (reach_[step.from].through == kNoIndex) --state_.words[step.from].in_reserve;
  }
  if (end_.through == kNoIndex) --state_.reserve_left;
  --state_.words[source].deficit;
}

void PathSearch::forget() {
  for (const std::uint32_t word : reached_) {
    reach_[word] = {};
    is_visited_[word] = 0;
  }
  reached_.clear();
  heap_.clear();
  is_open_listed_ = false;
  open_count_ = state_.owner.size();
  reserve_reach_ = {};
  is_reserve_visited_ = false;
  end_ = {};
}

}  // namespace triglyph
