// This work is based on:
//  - R. Jonker, A. Volgenant: A shortest augmenting path algorithm for dense and sparse linear
//    assignment problems, 1987 (augmenting row reduction, shortest paths over dual values).
//  - Y. Lee, J. B. Orlin: On very large-scale assignment problems, 1993 (work on the cheapest
//    pairs, bring in the others when the dual values ask for them).
// Deviations:
//  1. A word has several copies, so bids and searches handle whole words: the nodes of the search
//     graph are words, however many units there are.
//  2. Prices never fall. The lower bound of a candidate list therefore stays valid, and the search
//     renews the list when the path length reaches that bound. The result is exact without a final
//     pricing pass.
//  3. If many costs tie, the bids start from a maximum matching of the tied pairs.
//  4. If the searches turn out to be long, an auction with epsilon scaling (D. P. Bertsekas: The
//     auction algorithm, 1988) finds better prices first.
#include "engine/assignment/transport.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "engine/assignment/assignment.h"
#include "engine/assignment/matching.h"
#include "engine/assignment/path_search.h"
#include "engine/assignment/transport_state.h"
#include "engine/base/error.h"
#include "engine/base/parallel.h"
#include "engine/base/stop.h"

namespace triglyph {
namespace {

// Tied best units per copy that make a matching worthwhile: distinct costs have hardly more than
// one.
constexpr std::size_t kManyTies = 2;
constexpr std::uint32_t kBidsPerWord = 6;  // on average; more bids save few searches
// Visits per word after which the searches give way to an auction, which costs about as much as
// some dozen visits per word.
constexpr std::size_t kMostVisitsPerWord = 20;
constexpr std::size_t kAuctionBidsPerWord = 40;  // an upper bound; a round usually ends sooner
constexpr std::size_t kTurnsAhead = 64;          // enough lists to renew to keep the threads busy
// The auction's steps (epsilon): the first and the last as a share of the widest gap between the
// candidates of a word, and the factor between one round's and the next. A finer last step shortens
// the searches that remain, at the cost of more rounds.
constexpr double kFirstStep = 0.1;
constexpr double kLastStep = 1e-4;
constexpr double kStepRatio = 6;

struct Offer {
  double key;
  std::uint32_t unit;
  float cost;
};

// The listed pairs of a word at current prices.
struct Offers {
  std::vector<Offer> pairs;
  double value = kInfinity;  // key of the best pair beyond the word's copies
};

// Evaluates the list of a word. Returns false if pairs that it leaves out may be better.
bool evaluate_list(const TransportState& state, std::uint32_t word, Offers& offers) {
  const TransportWord& w = state.words[word];
  const std::size_t copies = w.held.size() + w.deficit;
  offers.pairs.clear();
  for (const Candidate& pair : w.list.pairs) {
    offers.pairs.push_back({pair.cost + state.prices[pair.unit], pair.unit, pair.cost});
  }
  offers.value = w.list.bound;
  if (offers.pairs.size() > copies) {
    const auto nth = offers.pairs.begin() + static_cast<std::ptrdiff_t>(copies);
    std::nth_element(offers.pairs.begin(), nth, offers.pairs.end(),
                     [](const Offer& a, const Offer& b) {
                       return a.key != b.key ? a.key < b.key : a.unit < b.unit;
                     });
    offers.value = nth->key;
  }
  return offers.value <= w.list.bound;
}

void refresh_list(TransportState& state, std::uint32_t word, double step, Offers& offers) {
  while (!evaluate_list(state, word, offers)) {
    step > 0 ? state.renew_short_list(word) : state.renew_list(word);
  }
}

// Lets a word bid: it takes its best units, and raises their prices until they are as dear to it as
// the best unit it does not get, plus `step`. It takes a unit from another word only if that raises
// the price. Words that lose a unit are appended to `losers`.
void bid(TransportState& state, std::uint32_t word, double step, Offers& offers,
         std::vector<std::uint32_t>& losers) {
  TransportWord& w = state.words[word];
  refresh_list(state, word, step, offers);
  double value = offers.value;
  if (state.reserve_size > 0) value = std::min(value, state.reserve_price);
  // Without a next best pair there is nothing to raise the price to: the search decides.
  if (value == kInfinity) value = w.value;
  for (const Offer& offer : offers.pairs) {
    const std::uint32_t before = state.owner[offer.unit];
    const bool is_tied = offer.key == value && before != kNoIndex && step == 0;
    if (offer.key > value || is_tied) continue;
    if (before != word) {
      if (w.deficit == 0) continue;  // by rounding only: there is a copy for each better unit
      if (before != kNoIndex) {
        ++state.words[before].deficit;
        losers.push_back(before);
      }
      state.give(offer.unit, word);
      --w.deficit;
    }
    state.prices[offer.unit] = std::max(state.prices[offer.unit], value - offer.cost + step);
  }
  w.value = std::max(w.value, value);
}

// Renews, in parallel, the lists of the words that bid next. Their bids seldom need to renew them
// again, since prices never fall.
void refresh_next(TransportState& state, std::span<const std::uint32_t> next, double step) {
  parallel_for(
      next.size(),
      [&](std::size_t i) {
        if (state.words[next[i]].deficit == 0) return;
        thread_local Offers offers;
        refresh_list(state, next[i], step, offers);
      },
      4);
}

void bid_in_turns(TransportState& state, double step, std::size_t bids_per_word) {
  std::vector<std::uint32_t> queue(state.words.size());
  std::iota(queue.begin(), queue.end(), 0U);
  const std::size_t most = bids_per_word * state.words.size();
  Offers offers;
  std::size_t refreshed = 0;
  for (std::size_t head = 0; head < queue.size() && head < most; ++head) {
    stop_point();
    if (head == refreshed) {
      std::vector<std::uint32_t> next(
          queue.begin() + static_cast<std::ptrdiff_t>(head),
          queue.begin() + static_cast<std::ptrdiff_t>(std::min(queue.size(), head + kTurnsAhead)));
      refreshed = head + next.size();
      std::sort(next.begin(), next.end());
      next.erase(std::unique(next.begin(), next.end()), next.end());
      refresh_next(state, next, step);
    }
    const std::uint32_t word = queue[head];
    if (state.words[word].deficit == 0) continue;
    // A word is queued once for each unit it lost; its first bid replaces them all.
    bid(state, word, step, offers, queue);
  }
}

// Returns whether the words have far more tied best units than copies.
bool has_many_ties(const TransportState& state) {
  std::size_t copies = 0;
  std::size_t ties = 0;
  for (const TransportWord& word : state.words) {
    copies += word.deficit;
    for (const Candidate& pair : word.list.pairs) {
      ties += pair.cost + state.prices[pair.unit] <= word.value ? 1 : 0;
    }
  }
  return ties > kManyTies * copies;
}

// Assigns words to their tied best units by a maximum matching. If words chose one after another,
// they would take units that suit many words and leave those that suit only themselves.
void match_ties(TransportState& state) {
  PairGraph graph(static_cast<std::uint32_t>(state.owner.size()),
                  static_cast<std::uint32_t>(state.words.size()));
  std::vector<std::uint32_t> copies;
  for (const TransportWord& word : state.words) copies.push_back(word.deficit);
  parallel_for(state.words.size(), [&](std::size_t k) {
    const TransportWord& word = state.words[k];
    graph.set_row(static_cast<std::uint32_t>(k), [&](std::size_t unit) {
      const double key = word.column[unit] + state.prices[unit];
      return (key <= word.value) & (key < kInfinity);
    });
  });
  const Matching matching = grow_maximum_matching(graph, empty_matching(graph.units(), copies));
  for (std::uint32_t unit = 0; unit < graph.units(); ++unit) {
    if (matching.word_of_unit[unit] != kNoWord) state.give(unit, matching.word_of_unit[unit]);
  }
  for (std::size_t k = 0; k < state.words.size(); ++k) {
    state.words[k].deficit = matching.unserved[k];
  }
}

// Finds units for all copies that have none. Returns false if it stopped after `most_visits` visits
// to words.
bool serve_all(TransportState& state, std::size_t most_visits) {
  PathSearch search(state);
  for (std::uint32_t word = 0; word < state.words.size(); ++word) {
    while (state.words[word].deficit > 0) {
      if (search.visits() > most_visits) return false;
      search.serve(word);
    }
  }
  return true;
}

// Finds good prices by an auction with epsilon scaling, and restarts from those prices. The
// auction's assignment is discarded, so the result stays exact; but the remaining searches end
// within a few words.
void auction_prices(TransportState& state) {
  double widest = 0;
  for (const TransportWord& word : state.words) {
    for (const Candidate& pair : word.list.pairs) {
      widest = std::max(widest, pair.cost + state.prices[pair.unit] - word.value);
    }
  }
  double step = kFirstStep * widest;
  while (step > kLastStep * widest) {
    state.release_all_units();
    bid_in_turns(state, step, kAuctionBidsPerWord);
    step /= kStepRatio;
  }
  state.release_all_units();
  parallel_for(
      state.words.size(), [&](std::size_t k) { state.renew_value(static_cast<std::uint32_t>(k)); },
      4);
  match_ties(state);
}

}  // namespace

std::vector<std::uint32_t> solve_transport(const TransportProblem& problem) {
  check(problem.demand.size() == problem.costs.words, "one demand per word");
  check(problem.is_unit_open.size() == problem.costs.units, "one flag per unit");
  TransportState state(problem);
  if (has_many_ties(state)) match_ties(state);
  bid_in_turns(state, 0, kBidsPerWord);
  // An auction would leave positive prices on units that end up free, whose price must be 0.
  const std::size_t most_visits = state.has_optional_units
                                      ? std::numeric_limits<std::size_t>::max()
                                      : kMostVisitsPerWord * state.words.size();
  if (!serve_all(state, most_visits)) {
    auction_prices(state);
    serve_all(state, std::numeric_limits<std::size_t>::max());
  }
  std::vector<std::uint32_t> word_of_unit(problem.costs.units, kNoWord);
  for (std::size_t unit = 0; unit < word_of_unit.size(); ++unit) {
    if (state.owner[unit] != kNoIndex) word_of_unit[unit] = state.names[state.owner[unit]];
  }
  return word_of_unit;
}

}  // namespace triglyph
