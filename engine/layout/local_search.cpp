// This work is based on:
// Andrade, Resende, Werneck. Fast local search for the maximum independent set problem. Journal of
// Heuristics 18 (2012): swaps among units with a single blocker.
// Kirkpatrick, Gelatt, Vecchi. Optimization by simulated annealing. Science 220 (1983).
// Deviations:
//  1. Instead of looking for (1,2)-swaps, the search walks at random along (1,1)-swaps and takes
//     every unit that becomes free. Occasionally a unit replaces two, at a rate that falls with the
//     temperature. On mesh units, whose good solutions are many and close together, this finds
//     more.
//  2. Blocks of the graph are searched in parallel, each with its own random numbers. Units at the
//     border of a block stay fixed until the next round, which cuts the graph elsewhere. The result
//     is therefore the same for any number of threads.
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "engine/base/parallel.h"
#include "engine/base/random.h"
#include "engine/base/stop.h"
#include "engine/layout/budget.h"
#include "engine/layout/conflict_graph.h"

namespace triglyph {
namespace {

// Temperatures of the first and the last round, in units lost: about one step in ten thousand loses
// a unit, then hardly any.
constexpr double kHot = 0.105;
constexpr double kCold = 0.055;
constexpr int kRounds = 192;      // of cooling; borders of blocks move between them
constexpr std::size_t kCuts = 8;  // partitions into blocks, used in turn; fewer find fewer units
// Units in a block: few enough that a search fits a core's own cache, enough that borders are few.
constexpr std::uint32_t kLeastBlock = 4096;
constexpr std::uint32_t kMostBlock = 8192;

struct Site {
  std::uint32_t blocker_sum = 0;  // sum of the chosen neighbours' indices; with one, its index
  std::uint32_t place = 0;        // in the walker's list of swaps
  std::uint32_t blockers = 0;     // number of chosen neighbours
  bool is_chosen = false;
  bool is_movable = false;  // interior to its block in this round
};

struct Solution {
  const ConflictGraph& graph;
  std::vector<Site> sites;
};

// The search of one block in one round. Changes only sites of its own block.
class Walker {
 public:
  Walker(Solution& solution, std::span<const std::uint32_t> block, std::uint64_t stream)
      : graph_(solution.graph), sites_(solution.sites), stream_(stream) {
    for (const std::uint32_t unit : block) {
      if (!sites_[unit].is_movable) continue;
      movable_.push_back(unit);
      if (sites_[unit].is_chosen) continue;
      if (sites_[unit].blockers == 0) free_.push_back(unit);
      if (sites_[unit].blockers == 1) list_swap(unit);
    }
  }

  void walk(std::uint64_t steps, double temperature) {
    if (movable_.empty()) return;
    const double uphill = static_cast<double>(movable_.size()) * std::exp(-1 / temperature);
    fill();
    for (std::uint64_t step = 0; step < steps; ++step) {
      stop_point();
      const auto swaps = static_cast<double>(swaps_.size());
      const double pick = unit_random() * (std::max(swaps, 1.0) + uphill);
      if (pick < swaps) {
        swap(swaps_[static_cast<std::size_t>(pick)]);
      } else if (pick >= std::max(swaps, 1.0)) {
        climb(movable_[random() % movable_.size()]);
      }
      fill();
    }
  }

 private:
  [[nodiscard]] std::uint64_t random() { return mix_bits(stream_ ^ drawn_++); }
  [[nodiscard]] double unit_random() { return static_cast<double>(random() >> 11) * 0x1.0p-53; }

  void swap(std::uint32_t unit) {
    const std::uint32_t blocker = sites_[unit].blocker_sum;
    if (!sites_[blocker].is_movable) return;
    remove(blocker);
    insert(unit);
  }

  // Replaces two units by one. The walk proposes this at the rate at which a loss of one unit is
  // accepted at its temperature.
  void climb(std::uint32_t unit) {
    if (sites_[unit].blockers != 2 || sites_[unit].is_chosen) return;
    std::array<std::uint32_t, 2> blockers{};
    std::size_t found = 0;
    for (const std::uint32_t other : graph_.neighbours(unit)) {
      if (!sites_[other].is_chosen) continue;
      if (!sites_[other].is_movable) return;
      blockers.at(found++) = other;
    }
    for (const std::uint32_t blocker : blockers) remove(blocker);
    insert(unit);
  }

  // Adds every unit that has no chosen neighbour any more.
  void fill() {
    while (!free_.empty()) {
      const std::size_t at = free_.size() == 1 ? 0 : random() % free_.size();
      const std::uint32_t unit = free_[at];
      free_[at] = free_.back();
      free_.pop_back();
      if (sites_[unit].blockers == 0 && !sites_[unit].is_chosen) insert(unit);
    }
  }

  void insert(std::uint32_t unit) {
    sites_[unit].is_chosen = true;
    for (const std::uint32_t other : graph_.neighbours(unit)) {
      Site& site = sites_[other];
      site.blocker_sum += unit;
      const std::uint32_t before = site.blockers++;
      if (before > 1 || !site.is_movable) continue;
      before == 0 ? list_swap(other) : unlist_swap(other);
    }
  }

  void remove(std::uint32_t unit) {
    sites_[unit].is_chosen = false;
    free_.push_back(unit);
    for (const std::uint32_t other : graph_.neighbours(unit)) {
      Site& site = sites_[other];
      site.blocker_sum -= unit;
      const std::uint32_t after = --site.blockers;
      if (after > 1 || !site.is_movable) continue;
      if (after == 1) {
        list_swap(other);
      } else {
        unlist_swap(other);
        free_.push_back(other);
      }
    }
  }

  void list_swap(std::uint32_t unit) {
    sites_[unit].place = static_cast<std::uint32_t>(swaps_.size());
    swaps_.push_back(unit);
  }

  void unlist_swap(std::uint32_t unit) {
    const std::uint32_t last = swaps_.back();
    swaps_[sites_[unit].place] = last;
    sites_[last].place = sites_[unit].place;
    swaps_.pop_back();
  }

  const ConflictGraph& graph_;
  std::vector<Site>& sites_;
  std::uint64_t stream_;
  std::uint64_t drawn_ = 0;
  std::vector<std::uint32_t> movable_;
  std::vector<std::uint32_t> swaps_;  // movable, with one blocker
  std::vector<std::uint32_t> free_;   // superset of those without a chosen neighbour
};

// The number of steps per unit in each round: an even share of the iterations, or of the time left.
class Pace {
 public:
  explicit Pace(const LayoutOptions& options) : options_(options), budget_(options) {}

  // Returns 0 if the time is up.
  [[nodiscard]] double steps_of_round(int round) {
    if (!budget_.is_timed()) return static_cast<double>(options_.iterations) / kRounds;
    const double elapsed = budget_.elapsed_seconds();
    if (round == 0) prepared_ = elapsed;
    const double left = std::max(0.0, options_.seconds - elapsed);
    const double speed = round == 0 ? 0 : done_ / std::max(elapsed - prepared_, 1e-9);
    const double steps = round == 0 ? kFirstSteps : speed * left / (kRounds - round);
    done_ += steps;
    return left > 0 ? steps : 0;
  }

 private:
  static constexpr double kFirstSteps = 0.25;
  const LayoutOptions& options_;
  Budget budget_;
  double prepared_ = 0;  // seconds until the first round
  double done_ = 0;      // steps a unit so far
};

std::vector<GraphBlocks> cut_graph(const ConflictGraph& graph, std::uint64_t seed) {
  const std::uint32_t size = std::clamp(graph.size() / 16, kLeastBlock, kMostBlock);
  std::vector<GraphBlocks> cuts(graph.size() <= size ? 1 : kCuts);
  parallel_for(cuts.size(), [&](std::size_t i) { cuts[i] = GraphBlocks(graph, size, seed + i); });
  return cuts;
}

class Search {
 public:
  Search(const ConflictGraph& graph, const LayoutOptions& options)
      : options_(options),
        solution_{graph, std::vector<Site>(graph.size())},
        cuts_(cut_graph(graph, options.seed)) {}

  // Adds, in this order, every unit without a chosen neighbour; keeps the result if it is the best
  // so far.
  void complete(std::span<const std::uint32_t> order) {
    for (const std::uint32_t unit : order) {
      Site& site = solution_.sites[unit];
      if (site.is_chosen || site.blockers > 0) continue;
      site.is_chosen = true;
      for (const std::uint32_t other : solution_.graph.neighbours(unit)) {
        solution_.sites[other].blocker_sum += unit;
        ++solution_.sites[other].blockers;
      }
    }
    std::vector<std::uint32_t> chosen;
    for (std::uint32_t unit = 0; unit < solution_.sites.size(); ++unit) {
      if (!solution_.sites[unit].is_chosen) continue;
      chosen.push_back(unit);
    }
    if (chosen.size() <= best_.size() && !best_.empty()) return;
    best_ = std::move(chosen);
  }

  void walk(int round, double steps_a_unit) {
    const GraphBlocks& cut = cuts_[static_cast<std::size_t>(round) % cuts_.size()];
    const double temperature = kHot * std::pow(kCold / kHot, round / (kRounds - 1.0));
    parallel_for(cut.size(), [&](std::size_t block) {
      const auto units = cut.units(block);
      for (const std::uint32_t unit : units) {
        solution_.sites[unit].is_movable = cut.is_interior(unit);
      }
      Walker walker(solution_, units,
                    random_bits(options_.seed, static_cast<std::uint64_t>(round), block));
      walker.walk(static_cast<std::uint64_t>(steps_a_unit * static_cast<double>(units.size())),
                  temperature);
    });
  }

  [[nodiscard]] std::vector<std::uint32_t> best() const { return best_; }

 private:
  const LayoutOptions& options_;
  Solution solution_;
  std::vector<GraphBlocks> cuts_;
  std::vector<std::uint32_t> best_;
};

}  // namespace

std::vector<std::uint32_t> local_search_layout(const Conflicts& conflicts,
                                               const LayoutOptions& options) {
  Pace pace(options);
  const ConflictGraph graph(conflicts);
  std::vector<std::uint32_t> all(graph.size());
  std::iota(all.begin(), all.end(), 0U);

  Search search(graph, options);
  search.complete(min_degree_layout(conflicts));
  for (int round = 0; round < kRounds; ++round) {
    const double steps = pace.steps_of_round(round);
    if (steps <= 0) break;
    search.walk(round, steps);
  }
  search.complete(all);
  return search.best();
}

}  // namespace triglyph
