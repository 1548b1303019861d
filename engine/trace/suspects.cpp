#include "engine/trace/suspects.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <set>
#include <string>
#include <utility>

#include "engine/base/parallel.h"

namespace triglyph {
namespace {

// Names that are weighed against every table.
constexpr std::size_t kWeighed = 1000;

// Symbols of a layer that are looked up for every other name.
constexpr std::size_t kLookedUp = 1300;

constexpr std::size_t kNamesPerTask = 256;

// Returns the tables for a first look: of each layer those that weigh most, of each kind of units
// the one that is the least misled by several who combined their copies.
std::vector<const ScoreTable*> tables_for_screening(std::span<const ScoreTable> tables) {
  std::vector<const ScoreTable*> ranked;
  for (const ScoreTable& table : tables) ranked.push_back(&table);
  std::stable_sort(ranked.begin(), ranked.end(), [](const ScoreTable* a, const ScoreTable* b) {
    return a->weight() > b->weight();
  });
  std::vector<const ScoreTable*> chosen;
  for (const FingerprintLayer layer :
       {FingerprintLayer::Units, FingerprintLayer::Flux, FingerprintLayer::Points}) {
    std::set<std::pair<std::string, int>> kinds;
    std::size_t symbols = 0;
    for (const ScoreTable* best : ranked) {
      if (best->layer != layer) continue;
      const bool is_units = layer == FingerprintLayer::Units;
      if (is_units && !kinds.emplace(best->what, best->bits).second) continue;
      const ScoreTable* table = best;
      for (const ScoreTable& other : tables) {
        const bool is_alike =
            other.layer == layer && other.what == best->what && other.bits == best->bits;
        // the last of a kind believes least
        if (is_units && is_alike && other.colluders == 2) table = &other;
      }
      if (symbols > 0 && symbols + table->symbols.size() > kLookedUp) break;
      symbols += table->symbols.size();
      chosen.push_back(table);
    }
  }
  return chosen;
}

// Returns the numbers of the names that do best at a first look, ascending.
std::vector<std::size_t> screened(std::span<const ScoreTable> tables, const FingerprintCode& code,
                                  std::span<const FingerprintSeed> seeds) {
  const std::vector<const ScoreTable*> chosen = tables_for_screening(tables);
  std::vector<float> scores(seeds.size());
  parallel_for(
      seeds.size(),
      [&](std::size_t i) {
        std::array<double, 3> best{};  // over the tables of each layer
        for (const ScoreTable* table : chosen) {
          double& of_layer = best.at(static_cast<std::size_t>(table->layer));
          of_layer = std::max(of_layer, table->score(code, seeds[i]) + table->prior);
        }
        scores[i] = static_cast<float>(best[0] + best[1] + best[2]);
      },
      kNamesPerTask);
  std::vector<std::size_t> names(seeds.size());
  std::iota(names.begin(), names.end(), std::size_t{0});
  const auto end = names.begin() + static_cast<std::ptrdiff_t>(kWeighed);
  std::nth_element(names.begin(), end, names.end(), [&](std::size_t a, std::size_t b) {
    return scores[a] != scores[b] ? scores[a] > scores[b] : a < b;
  });
  names.erase(end, names.end());
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace

std::vector<FingerprintSeed> seeds_of(const FingerprintCode& code,
                                      std::span<const std::vector<std::uint8_t>> names) {
  std::vector<FingerprintSeed> seeds(names.size());
  parallel_for(
      names.size(), [&](std::size_t i) { seeds[i] = code.seed_of(names[i]); }, kNamesPerTask);
  return seeds;
}

std::vector<Scored> best_of(std::span<const ScoreTable> tables, const FingerprintCode& code,
                            std::span<const FingerprintSeed> seeds, std::size_t most) {
  std::vector<std::size_t> names;
  if (seeds.size() > kWeighed) {
    names = screened(tables, code, seeds);
  } else {
    names.resize(seeds.size());
    std::iota(names.begin(), names.end(), std::size_t{0});
  }
  std::vector<FingerprintSeed> weighed(names.size());
  for (std::size_t i = 0; i < names.size(); ++i) weighed[i] = seeds[names[i]];
  std::vector<NameEvidence> evidence = evidence_of_each(tables, code, weighed);
  std::vector<Scored> scored(names.size());
  for (std::size_t i = 0; i < names.size(); ++i) scored[i] = {names[i], std::move(evidence[i])};
  std::stable_sort(scored.begin(), scored.end(), [](const Scored& a, const Scored& b) {
    return a.evidence.bits > b.evidence.bits;
  });
  if (scored.size() > most) scored.resize(most);
  return scored;
}

}  // namespace triglyph
