// This work is based on:
//  - R. Jonker, A. Volgenant: A shortest augmenting path algorithm for dense and sparse linear
//    assignment problems, 1987 (augmenting row reduction, shortest paths over dual values).
//  - Y. Lee, J. B. Orlin: On very large-scale assignment problems, 1993 (work on the cheapest
//    pairs, bring in the others when the dual values ask for them).
// Deviations:
//  1. Words are wanted several times, so a bid and a path end handle whole words: the graph that
//     is searched has words for nodes, however many units there are.
//  2. Prices only ever rise. A word's list of candidates made at any time therefore keeps its lower
//     bound on all other pairs, and is renewed in the search when the path length reaches that
//     bound: exact without a pricing pass at the end.
//  3. Where costs tie, the bids start from a maximum matching of the tied pairs.
//  4. Where searches turn out to be long, an auction with shrinking steps (D. P. Bertsekas: The
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

namespace triglyph {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kManyTies = 2;  // best units a copy; distinct costs have hardly more than one
constexpr std::uint32_t kBidsPerWord = 6;  // on average; more bids save few searches
// An auction costs about as much as searches that visit each word some dozen times.
constexpr std::size_t kPatience = 20;
constexpr std::size_t kAuctionBidsPerWord = 40;  // a round ends sooner as a rule
constexpr std::size_t kTurnsAhead = 64;
constexpr double kFirstStep = 0.1;  // of the widest gap between a word's candidates
constexpr double kLastStep = 1e-4;
constexpr double kStepRatio = 6;

struct Offer {
  double key;
  std::uint32_t unit;
  float cost;
};

// What the word can see of its pairs now, and the value of the best one it would not get; false if
// its list leaves out pairs that may be better.
struct Offers {
  std::vector<Offer> pairs;
  double value = kInfinity;
};

bool look_at_list(const TransportState& state, std::uint32_t word, Offers& offers) {
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
  while (!look_at_list(state, word, offers)) {
    step > 0 ? state.renew_short_list(word) : state.renew_list(word);
  }
}

// The word takes its best units at the value of the best one it does not get, and raises their
// prices so that it likes them just as well, or less by `step`. It takes units from others only
// where that raises the price; the words that lost a unit are appended to losers.
void bid(TransportState& state, std::uint32_t word, double step, Offers& offers,
         std::vector<std::uint32_t>& losers) {
  TransportWord& w = state.words[word];
  refresh_list(state, word, step, offers);
  double value = offers.value;
  if (state.reserve_size > 0) value = std::min(value, state.reserve_price);
  // Without a next best pair there is no price to raise: the search decides.
  if (value == kInfinity) value = w.value;
  for (const Offer& offer : offers.pairs) {
    const std::uint32_t before = state.owner[offer.unit];
    const bool is_tied = offer.key == value && before != kNobody && step == 0;
    if (offer.key > value || is_tied) continue;
    if (before != word) {
      if (w.deficit == 0) continue;  // only by rounding: there is one copy for each better unit
      if (before != kNobody) {
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

// The lists of the words whose turn comes next, renewed at the prices of now, which only rise: what
// is renewed here seldom is when the turn comes.
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
    // A word that lost several units waits in the queue once for each; the first turn serves all.
    bid(state, word, step, offers, queue);
  }
}

// Whether the words like far more units best than they can use.
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

// Gives each word as many of the units it likes best as can be done for all words together. Taken
// one by one, words would take the units that suit everybody and leave those that suit only them.
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

// Searches for units for all copies that lack one; false if it gave up after visiting that many
// words.
bool serve_all(TransportState& state, std::size_t patience) {
  PathSearch search(state);
  for (std::uint32_t word = 0; word < state.words.size(); ++word) {
    while (state.words[word].deficit > 0) {
      if (search.visits() > patience) return false;
      search.serve(word);
    }
  }
  return true;
}

// Finds good prices by an auction in which every bid overpays by a step, in rounds of ever smaller
// steps, and begins anew from them. Whatever the auction gave to whom is forgotten, so the answer
// is as exact as before; but the searches that are left end within a few words.
void auction_prices(TransportState& state) {
  double widest = 0;
  for (const TransportWord& word : state.words) {
    for (const Candidate& pair : word.list.pairs) {
      widest = std::max(widest, pair.cost + state.prices[pair.unit] - word.value);
    }
  }
  double step = kFirstStep * widest;
  while (step > kLastStep * widest) {
    state.take_everything_back();
    bid_in_turns(state, step, kAuctionBidsPerWord);
    step /= kStepRatio;
  }
  state.take_everything_back();
  parallel_for(
      state.words.size(), [&](std::size_t k) { state.renew_value(static_cast<std::uint32_t>(k)); },
      4);
  match_ties(state);
}

}  // namespace

std::vector<std::uint32_t> solve_transport(const TransportProblem& problem) {
  check(problem.demand.size() == problem.costs.words, "one demand a word");
  check(problem.is_unit_open.size() == problem.costs.units, "one mark a unit");
  TransportState state(problem);
  if (has_many_ties(state)) match_ties(state);
  bid_in_turns(state, 0, kBidsPerWord);
  // An auction would leave prices on units that end up free, where only 0 will do.
  const std::size_t patience =
      state.is_choice ? std::numeric_limits<std::size_t>::max() : kPatience * state.words.size();
  if (!serve_all(state, patience)) {
    auction_prices(state);
    serve_all(state, std::numeric_limits<std::size_t>::max());
  }
  std::vector<std::uint32_t> word_of_unit(problem.costs.units, kNoWord);
  for (std::size_t unit = 0; unit < word_of_unit.size(); ++unit) {
    if (state.owner[unit] != kNobody) word_of_unit[unit] = state.names[state.owner[unit]];
  }
  return word_of_unit;
}

}  // namespace triglyph
