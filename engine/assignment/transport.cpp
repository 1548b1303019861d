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
//  3. Units nobody wants are the copies of one more word that costs nothing; copies that find no
//     unit go to a reserve that costs nothing. Both sides are then served completely and the dual
//     values have no signs to keep.
#include "engine/assignment/transport.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "engine/assignment/assignment.h"
#include "engine/assignment/candidates.h"
#include "engine/assignment/matching.h"
#include "engine/base/error.h"
#include "engine/base/parallel.h"
#include "engine/base/random.h"

namespace triglyph {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::uint32_t kNobody = 0xffffffff;
constexpr std::size_t kManyTies = 2;  // best units a copy; distinct costs have hardly more than one
constexpr std::size_t kManyOpen = 8;  // a renewal costs about as much as a look at n / 8 open units
constexpr std::size_t kLongList = 32;  // times the first list's width
constexpr std::size_t kSpareCandidates = 16;
constexpr std::uint32_t kBidsPerWord = 6;  // on average; more bids save few searches

// Invariants: value <= cost + price over all pairs of the word that are allowed, with equality for
// the units it holds; the same for the reserve, whose cost is 0.
struct Word {
  std::span<const float> column;
  std::uint32_t deficit = 0;     // copies still without unit
  std::uint32_t in_reserve = 0;  // copies that found no unit
  std::size_t width = 0;         // of the list of candidates, at least
  std::size_t first_width = 0;
  double value = 0;
  CandidateList list{};
  std::vector<std::uint32_t> held{};  // units
};

// How the search came to a word: through a unit it holds, or through its copy in the reserve.
struct Reach {
  double distance = kInfinity;
  std::uint32_t from = kNobody;
  std::uint32_t through = kNobody;  // unit; kNobody for the reserve
};

class Transport {
 public:
  explicit Transport(const TransportProblem& problem);
  void solve();
  [[nodiscard]] std::vector<std::uint32_t> word_of_unit() const;

 private:
  // What the search visits next. Words come before renewals at the same distance.
  struct Event {
    double distance;
    std::uint32_t code;
    bool operator<(const Event& other) const {
      return distance != other.distance ? distance > other.distance : code > other.code;
    }
  };

  void count_copies(const TransportProblem& problem);
  void set_first_prices(const TransportProblem& problem);
  void renew_list(std::uint32_t word);
  void give(std::uint32_t unit, std::uint32_t word);
  [[nodiscard]] bool has_many_ties() const;
  void match_ties();
  void bid_in_turns();
  void bid(std::uint32_t word, std::vector<std::uint32_t>& losers);
  void serve(std::uint32_t source);
  void visit(std::uint32_t word);
  void visit_beyond_list(std::uint32_t word);
  void visit_reserve();
  void follow(std::uint32_t word, std::uint32_t unit, double distance);
  [[nodiscard]] bool is_closed(std::uint32_t unit) const {
    return owner_[unit] != kNobody ? is_visited_[owner_[unit]] != 0 : prices_[unit] == kInfinity;
  }
  void reach(std::uint32_t word, double distance, std::uint32_t from, std::uint32_t through);
  void push(double distance, std::uint32_t code);
  void raise_values();
  void shift_along_path(std::uint32_t source);

  float limit_ = 0;
  std::vector<std::uint32_t> names_;  // of words_ in the problem; the unwanted word is kNoWord
  std::vector<Word> words_;
  std::vector<float> zeros_;          // column of the unwanted word
  std::vector<double> prices_;        // of units
  std::vector<std::uint32_t> owner_;  // index in words_ or kNobody
  std::vector<std::uint32_t> place_;  // of a unit among its owner's held
  std::uint32_t reserve_left_ = 0;
  std::uint32_t reserve_size_ = 0;
  double reserve_price_ = 0;

  // One search.
  std::vector<Reach> reach_;
  std::vector<std::uint8_t> is_visited_;
  std::vector<std::uint32_t> reached_;  // words to forget afterwards
  std::vector<Event> heap_;
  std::vector<std::uint32_t> open_units_;  // all that a visited word does not hold, and some more
  bool is_open_listed_ = false;
  std::size_t open_count_ = 0;  // units no visited word holds
  Reach reserve_reach_;
  bool is_reserve_visited_ = false;
  Reach end_;  // nearest free unit, or room in the reserve
};

Transport::Transport(const TransportProblem& problem) : limit_(problem.limit) {
  owner_.assign(problem.costs.units, kNobody);
  place_.assign(problem.costs.units, 0);
  open_count_ = owner_.size();
  count_copies(problem);
  reach_.resize(words_.size());
  is_visited_.resize(words_.size());
  set_first_prices(problem);
  parallel_for(
      words_.size(),
      [&](std::size_t k) {
        Word& word = words_[k];
        renew_list(static_cast<std::uint32_t>(k));
        word.value = reserve_size_ > 0 ? reserve_price_ : kInfinity;
        for (const Candidate& pair : word.list.pairs) {
          word.value = std::min(word.value, pair.cost + prices_[pair.unit]);
        }
      },
      4);
}

void Transport::count_copies(const TransportProblem& problem) {
  std::uint64_t open = 0;
  for (const std::uint8_t is_open : problem.is_unit_open) open += is_open != 0;
  std::uint64_t copies = 0;
  for (std::uint32_t name = 0; name < problem.costs.words; ++name) {
    // More copies than units are never served; leaving them out keeps the counts small.
    const auto wanted =
        static_cast<std::uint32_t>(std::min<std::uint64_t>(problem.demand[name], open));
    if (wanted == 0) continue;
    names_.push_back(name);
    words_.push_back({problem.costs.column(name), wanted});
    copies += wanted;
  }
  if (copies > open) {
    check(copies - open < kNobody, "copies that find no unit are counted in 32 bits");
    reserve_size_ = reserve_left_ = static_cast<std::uint32_t>(copies - open);
  }
  if (copies < open) {
    zeros_.assign(problem.costs.units, 0.0F);
    names_.push_back(kNoWord);
    words_.push_back({zeros_, static_cast<std::uint32_t>(open - copies)});
  }
  for (Word& word : words_) {
    word.first_width = word.width = word.deficit + word.deficit / 4 + kSpareCandidates;
  }
}

// A unit's price starts at minus its cheapest pair: a unit that is expensive for every word alike
// then looks like any other. With units to spare only the cheapest, as many as there are copies,
// are treated so; the unwanted word takes the rest as they are.
void Transport::set_first_prices(const TransportProblem& problem) {
  std::vector<float> least(problem.costs.units, std::numeric_limits<float>::infinity());
  const std::size_t wanted_words = words_.size() - (zeros_.empty() ? 0 : 1);
  parallel_blocks(
      least.size(),
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = 0; k < wanted_words; ++k) {
          const float* column = words_[k].column.data();
          for (std::size_t unit = begin; unit < end; ++unit) {
            least[unit] = column[unit] < least[unit] ? column[unit] : least[unit];
          }
        }
      },
      1024);
  float highest = limit_;
  if (!zeros_.empty()) {
    std::vector<float> ordered;
    for (std::size_t unit = 0; unit < least.size(); ++unit) {
      if (problem.is_unit_open[unit] != 0) ordered.push_back(least[unit]);
    }
    const auto nth = ordered.end() - words_.back().deficit;
    std::nth_element(ordered.begin(), nth, ordered.end());
    highest = std::min(limit_, *nth);
  }
  prices_.resize(least.size());
  for (std::size_t unit = 0; unit < least.size(); ++unit) {
    const double start = -static_cast<double>(std::min(least[unit], highest));
    prices_[unit] = problem.is_unit_open[unit] != 0 ? start : kInfinity;
  }
}

void Transport::renew_list(std::uint32_t word) {
  Word& w = words_[word];
  const double old_bound = w.list.pairs.empty() ? -kInfinity : w.list.bound;
  w.list = pick_candidates(w.column, prices_, {w.width, limit_, mix_bits(word)});
  // Many equally good units: look at more of them the next time.
  if (w.list.bound <= old_bound) w.width *= 2;
}

void Transport::give(std::uint32_t unit, std::uint32_t word) {
  const std::uint32_t before = owner_[unit];
  if (before != kNobody) {
    std::vector<std::uint32_t>& held = words_[before].held;
    held[place_[unit]] = held.back();
    place_[held.back()] = place_[unit];
    held.pop_back();
  }
  owner_[unit] = word;
  place_[unit] = static_cast<std::uint32_t>(words_[word].held.size());
  words_[word].held.push_back(unit);
}

// The word takes its best units at the value of the best one it does not get, and raises their
// prices so that it likes them just as well. It takes units from others only where that raises the
// price; the words that lost a unit are appended to losers.
void Transport::bid(std::uint32_t word, std::vector<std::uint32_t>& losers) {
  Word& w = words_[word];
  const std::size_t copies = w.held.size() + w.deficit;
  struct Offer {
    double key;
    std::uint32_t unit;
    float cost;
  };
  std::vector<Offer> offers;
  double value = kInfinity;
  for (;;) {
    offers.clear();
    for (const Candidate& pair : w.list.pairs) {
      offers.push_back({pair.cost + prices_[pair.unit], pair.unit, pair.cost});
    }
    value = w.list.bound;
    if (offers.size() > copies) {
      const auto nth = offers.begin() + static_cast<std::ptrdiff_t>(copies);
      std::nth_element(offers.begin(), nth, offers.end(), [](const Offer& a, const Offer& b) {
        return a.key != b.key ? a.key < b.key : a.unit < b.unit;
      });
      value = nth->key;
    }
    if (value <= w.list.bound) break;
    renew_list(word);
  }
  if (reserve_size_ > 0) value = std::min(value, reserve_price_);
  // Without a next best pair there is no price to raise: the search decides.
  if (value == kInfinity) value = w.value;
  for (const Offer& offer : offers) {
    const std::uint32_t before = owner_[offer.unit];
    if (offer.key > value || (offer.key == value && before != kNobody)) continue;
    if (before != word) {
      if (w.deficit == 0) continue;  // only by rounding: there is one copy for each better unit
      if (before != kNobody) {
        ++words_[before].deficit;
        losers.push_back(before);
      }
      give(offer.unit, word);
      --w.deficit;
    }
    prices_[offer.unit] = std::max(prices_[offer.unit], value - offer.cost);
  }
  w.value = std::max(w.value, value);
}

void Transport::bid_in_turns() {
  std::vector<std::uint32_t> queue(words_.size());
  std::iota(queue.begin(), queue.end(), 0U);
  const std::size_t most = kBidsPerWord * words_.size();
  for (std::size_t head = 0; head < queue.size() && head < most; ++head) {
    const std::uint32_t word = queue[head];
    if (words_[word].deficit == 0) continue;
    // A word that lost several units waits in the queue once for each; the first turn serves all.
    bid(word, queue);
  }
}

void Transport::push(double distance, std::uint32_t code) {
  heap_.push_back({distance, code});
  std::push_heap(heap_.begin(), heap_.end());
}

void Transport::reach(std::uint32_t word, double distance, std::uint32_t from,
                      std::uint32_t through) {
  if (reach_[word].distance == kInfinity) reached_.push_back(word);
  reach_[word] = {distance, from, through};
  push(distance, word);
}

void Transport::follow(std::uint32_t word, std::uint32_t unit, double distance) {
  if (distance >= end_.distance) return;
  const std::uint32_t owner = owner_[unit];
  if (owner == kNobody) {
    end_ = {distance, word, unit};
  } else if (distance < reach_[owner].distance) {
    reach(owner, distance, word, unit);
  }
}

// Follows the candidates of a word to the words that hold them, to a free unit, to the reserve.
void Transport::visit(std::uint32_t word) {
  const Word& w = words_[word];
  const double distance = reach_[word].distance;
  const double base = distance - w.value;
  for (const Candidate& pair : w.list.pairs) {
    follow(word, pair.unit, std::max(distance, base + (pair.cost + prices_[pair.unit])));
  }
  const double renewal = std::max(distance, base + w.list.bound);
  if (renewal < end_.distance) push(renewal, static_cast<std::uint32_t>(words_.size()) + word);
  if (reserve_size_ == 0) return;
  const double next = std::max(distance, base + reserve_price_);
  if (reserve_left_ > 0 && next < end_.distance) end_ = {next, word, kNobody};
  if (reserve_left_ == 0 && next < reserve_reach_.distance) {
    reserve_reach_ = {next, word, kNobody};
    push(next, static_cast<std::uint32_t>(2 * words_.size()));
  }
}

// The list of a word is used up. A new one serves later searches too; but where the search has
// been almost everywhere, or the list has grown long already, looking at the units whose owner was
// not visited yet costs less.
void Transport::visit_beyond_list(std::uint32_t word) {
  const bool has_many_open = open_count_ * kManyOpen > owner_.size();
  if (has_many_open && words_[word].width < kLongList * words_[word].first_width) {
    renew_list(word);
    visit(word);
    return;
  }
  if (!is_open_listed_) {
    open_units_.resize(owner_.size());
    std::iota(open_units_.begin(), open_units_.end(), 0U);
    is_open_listed_ = true;
  }
  const double distance = reach_[word].distance;
  const double base = distance - words_[word].value;
  const float* column = words_[word].column.data();
  std::size_t kept = 0;
  for (const std::uint32_t unit : open_units_) {
    if (is_closed(unit)) continue;
    open_units_[kept++] = unit;
    if (column[unit] > limit_) continue;
    follow(word, unit, std::max(distance, base + (column[unit] + prices_[unit])));
  }
  open_units_.resize(kept);
}

void Transport::visit_reserve() {
  for (std::uint32_t word = 0; word < words_.size(); ++word) {
    if (words_[word].in_reserve > 0 && reserve_reach_.distance < reach_[word].distance) {
      reach(word, reserve_reach_.distance, reserve_reach_.from, kNobody);
    }
  }
}

// Dijkstra's search from a word that lacks a unit, over values and prices.
void Transport::serve(std::uint32_t source) {
  const auto count = static_cast<std::uint32_t>(words_.size());
  reach(source, 0, kNobody, kNobody);
  while (!heap_.empty()) {
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
      open_count_ -= words_[event.code].held.size();
      visit(event.code);
    }
  }
  check(end_.distance < kInfinity, "one side can be served completely");
  raise_values();
  shift_along_path(source);
  for (const std::uint32_t word : reached_) {
    reach_[word] = {};
    is_visited_[word] = 0;
  }
  reached_.clear();
  heap_.clear();
  is_open_listed_ = false;
  open_count_ = owner_.size();
  reserve_reach_ = {};
  is_reserve_visited_ = false;
  end_ = {};
}

// Makes the pairs of the path as good as each word's best, and leaves no pair better than that.
void Transport::raise_values() {
  for (const std::uint32_t word : reached_) {
    const double rise = end_.distance - reach_[word].distance;
    if (is_visited_[word] == 0 || rise <= 0) continue;
    words_[word].value += rise;
    for (const std::uint32_t unit : words_[word].held) prices_[unit] += rise;
  }
  if (is_reserve_visited_) reserve_price_ += end_.distance - reserve_reach_.distance;
}

void Transport::shift_along_path(std::uint32_t source) {
  for (Reach step = end_;; step = reach_[step.from]) {
    // The word gets what the next word on the path, or nobody, gives up.
    if (step.through != kNobody) {
      give(step.through, step.from);
    } else {
      ++words_[step.from].in_reserve;
    }
    if (step.from == source) break;
    if (reach_[step.from].through == kNobody) --words_[step.from].in_reserve;
  }
  if (end_.through == kNobody) --reserve_left_;
  --words_[source].deficit;
}

// Whether the words like far more units best than they can use.
bool Transport::has_many_ties() const {
  std::size_t copies = 0;
  std::size_t ties = 0;
  for (const Word& word : words_) {
    copies += word.deficit;
    for (const Candidate& pair : word.list.pairs) {
      ties += pair.cost + prices_[pair.unit] <= word.value ? 1 : 0;
    }
  }
  return ties > kManyTies * copies;
}

// Gives each word as many of the units it likes best as can be done for all words together. Taken
// one by one, words would take the units that suit everybody and leave those that suit only them.
void Transport::match_ties() {
  PairGraph graph(static_cast<std::uint32_t>(owner_.size()),
                  static_cast<std::uint32_t>(words_.size()));
  std::vector<std::uint32_t> copies;
  for (const Word& word : words_) copies.push_back(word.deficit);
  parallel_for(words_.size(), [&](std::size_t k) {
    const Word& word = words_[k];
    graph.set_row(static_cast<std::uint32_t>(k), [&](std::size_t unit) {
      return (word.column[unit] <= limit_) & (word.column[unit] + prices_[unit] <= word.value);
    });
  });
  const Matching matching = grow_maximum_matching(graph, empty_matching(graph.units(), copies));
  for (std::uint32_t unit = 0; unit < graph.units(); ++unit) {
    if (matching.word_of_unit[unit] != kNoWord) give(unit, matching.word_of_unit[unit]);
  }
  for (std::size_t k = 0; k < words_.size(); ++k) words_[k].deficit = matching.unserved[k];
}

void Transport::solve() {
  if (has_many_ties()) match_ties();
  bid_in_turns();
  for (std::uint32_t word = 0; word < words_.size(); ++word) {
    while (words_[word].deficit > 0) serve(word);
  }
}

std::vector<std::uint32_t> Transport::word_of_unit() const {
  std::vector<std::uint32_t> words(owner_.size(), kNoWord);
  for (std::size_t unit = 0; unit < owner_.size(); ++unit) {
    if (owner_[unit] != kNobody) words[unit] = names_[owner_[unit]];
  }
  return words;
}

}  // namespace

std::vector<std::uint32_t> solve_transport(const TransportProblem& problem) {
  check(problem.demand.size() == problem.costs.words, "one demand a word");
  check(problem.is_unit_open.size() == problem.costs.units, "one mark a unit");
  Transport transport(problem);
  transport.solve();
  return transport.word_of_unit();
}

}  // namespace triglyph
