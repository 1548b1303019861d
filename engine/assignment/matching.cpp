// This work is based on:
//  - J. E. Hopcroft, R. M. Karp: An n^(5/2) algorithm for maximum matchings in bipartite graphs,
//    1973; here a word may be matched several times, and 64 units share a machine word.
//  - A. L. Dulmage, N. S. Mendelsohn: Coverings of bipartite graphs, 1958.
#include "engine/assignment/matching.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <utility>

#include "engine/assignment/assignment.h"
#include "engine/base/parallel.h"
#include "engine/base/stop.h"

namespace triglyph {
namespace {

constexpr std::uint32_t kUnreached = 0xffffffff;

std::vector<std::uint64_t> all_ones(std::uint32_t units) {
  std::vector<std::uint64_t> bits((units + 63) / 64, ~std::uint64_t{0});
  if (units % 64 != 0) bits.back() >>= 64 - units % 64;
  return bits;
}

// Breadth-first layers: the distance of every word, counted in words, from the unserved words along
// alternating paths. find_layers() removes every unit that it reaches from units_left.
struct Layers {
  std::vector<std::uint32_t> layer_of_word;
  std::uint32_t last_layer = kUnreached;  // the first with a free unit in reach
};

Layers find_layers(const PairGraph& graph, const Matching& matching,
                   std::vector<std::uint64_t>& units_left, bool stop_at_free_unit) {
  Layers layers{std::vector<std::uint32_t>(graph.words(), kUnreached)};
  std::vector<std::uint32_t> queue;
  for (std::uint32_t word = 0; word < graph.words(); ++word) {
    if (matching.unserved[word] == 0) continue;
    layers.layer_of_word[word] = 0;
    queue.push_back(word);
  }
  for (std::size_t head = 0; head < queue.size(); ++head) {
    const std::uint32_t word = queue[head];
    stop_point();
    const std::uint32_t layer = layers.layer_of_word[word];
    if (layer > layers.last_layer) break;
    const auto row = graph.row(word);
    for (std::size_t block = 0; block < row.size(); ++block) {
      std::uint64_t fresh = row[block] & units_left[block];
      units_left[block] &= ~fresh;
      for (; fresh != 0; fresh &= fresh - 1) {
        const std::size_t unit = block * 64 + std::countr_zero(fresh);
        const std::uint32_t owner = matching.word_of_unit[unit];
        if (owner == kNoWord) {
          if (stop_at_free_unit) layers.last_layer = layer;
        } else if (layers.layer_of_word[owner] == kUnreached) {
          layers.layer_of_word[owner] = layer + 1;
          queue.push_back(owner);
        }
      }
    }
  }
  return layers;
}

// Finds augmenting paths that descend one layer at every step. Each unit is tried once per phase,
// and the scan of a word's row resumes where it stopped, so each row is scanned once per phase.
class PathFinder {
 public:
  PathFinder(const PairGraph& graph, const Layers& layers, Matching& matching)
      : graph_(graph),
        layers_(layers),
        matching_(matching),
        untried_(all_ones(graph.units())),
        next_block_(graph.words(), 0) {}

  bool augment_from(std::uint32_t source) {
    std::vector<Step>& path = path_;
    path.assign(1, {source, 0});
    while (!path.empty()) {
      stop_point();
      const std::uint32_t unit = next_unit(path.back().word);
      if (unit == kUnreached) {
        path.pop_back();
        continue;
      }
      path.back().unit = unit;
      const std::uint32_t owner = matching_.word_of_unit[unit];
      if (owner != kNoWord) {
        path.push_back({owner, 0});
        continue;
      }
      for (const Step& step : path) matching_.word_of_unit[step.unit] = step.word;
      --matching_.unserved[source];
      ++matching_.matched;
      return true;
    }
    return false;
  }

 private:
  struct Step {
    std::uint32_t word;
    std::uint32_t unit;
  };

  // An untried candidate of the word that is free or owned by a word of the next layer.
  std::uint32_t next_unit(std::uint32_t word) {
    const auto row = graph_.row(word);
    const std::uint32_t layer = layers_.layer_of_word[word];
    for (std::size_t& block = next_block_[word]; block < row.size(); ++block) {
      for (std::uint64_t open = row[block] & untried_[block]; open != 0; open &= open - 1) {
        const auto unit = static_cast<std::uint32_t>(block * 64 + std::countr_zero(open));
        const std::uint32_t owner = matching_.word_of_unit[unit];
        if (owner != kNoWord && layers_.layer_of_word[owner] != layer + 1) continue;
        if (owner != kNoWord && layer >= layers_.last_layer) continue;
        untried_[block] &= ~(open & (~open + 1));
        return unit;
      }
    }
    return kUnreached;
  }

  const PairGraph& graph_;
  const Layers& layers_;
  Matching& matching_;
  std::vector<std::uint64_t> untried_;
  std::vector<std::size_t> next_block_;
  std::vector<Step> path_;
};

// Gives words free units as long as there are any; the phases of Hopcroft and Karp complete the
// matching.
void match_greedily(const PairGraph& graph, Matching& matching) {
  std::vector<std::uint64_t> free = all_ones(graph.units());
  for (std::uint32_t unit = 0; unit < graph.units(); ++unit) {
    if (matching.word_of_unit[unit] != kNoWord) free[unit / 64] &= ~(std::uint64_t{1} << unit % 64);
  }
  for (std::uint32_t word = 0; word < graph.words(); ++word) {
    stop_point();
    const auto row = graph.row(word);
    for (std::size_t block = 0; block < row.size() && matching.unserved[word] > 0; ++block) {
      std::uint64_t open = row[block] & free[block];
      for (; open != 0 && matching.unserved[word] > 0; open &= open - 1) {
        const std::size_t unit = block * 64 + std::countr_zero(open);
        matching.word_of_unit[unit] = word;
        free[block] &= ~(std::uint64_t{1} << unit % 64);
        --matching.unserved[word];
        ++matching.matched;
      }
    }
  }
}

}  // namespace

PairGraph find_pairs_within(const CostMatrix& costs, float limit) {
  PairGraph graph(costs.units, costs.words);
  const float finite_limit = std::min(limit, std::numeric_limits<float>::max());
  parallel_for(costs.words, [&](std::size_t k) {
    const auto word = static_cast<std::uint32_t>(k);
    const float* column = costs.column(word).data();
    graph.set_row(word, [&](std::size_t unit) { return column[unit] <= finite_limit; });
  });
  return graph;
}

Matching empty_matching(std::uint32_t units, std::span<const std::uint32_t> demand) {
  return {std::vector<std::uint32_t>(units, kNoWord), {demand.begin(), demand.end()}, 0};
}

Matching grow_maximum_matching(const PairGraph& graph, Matching start) {
  Matching matching = std::move(start);
  match_greedily(graph, matching);
  while (matching.matched < graph.units()) {
    std::vector<std::uint64_t> units_left = all_ones(graph.units());
    const Layers layers = find_layers(graph, matching, units_left, true);
    if (layers.last_layer == kUnreached) break;
    PathFinder finder(graph, layers, matching);
    for (std::uint32_t word = 0; word < graph.words(); ++word) {
      while (matching.unserved[word] > 0 && finder.augment_from(word)) continue;
    }
  }
  return matching;
}

Scarcity find_scarcity(const PairGraph& graph, const Matching& maximum) {
  std::vector<std::uint64_t> units_left = all_ones(graph.units());
  const Layers layers = find_layers(graph, maximum, units_left, false);
  Scarcity scarcity{std::vector<std::uint8_t>(graph.words()),
                    std::vector<std::uint8_t>(graph.units())};
  for (std::uint32_t word = 0; word < graph.words(); ++word) {
    scarcity.is_scarce_word[word] = layers.layer_of_word[word] != kUnreached;
  }
  for (std::uint32_t unit = 0; unit < graph.units(); ++unit) {
    scarcity.is_scarce_unit[unit] = (units_left[unit / 64] >> unit % 64 & 1) == 0;
  }
  return scarcity;
}

}  // namespace triglyph
