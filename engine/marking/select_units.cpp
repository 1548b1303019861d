#include "engine/marking/select_units.h"

#include <algorithm>
#include <numeric>

#include "engine/base/error.h"

namespace triglyph {
namespace {

// Returns the least cost of every unit over a sample of the words.
std::vector<float> cheapest_costs(const BoundScheme& scheme, const UnitSet& units,
                                  std::span<const Word> words, bool is_spread) {
  std::vector<Word> probes;
  // units that carry a spread message have a word each
  const std::size_t step = is_spread ? 1 : (words.size() + kProbeWords - 1) / kProbeWords;
  for (std::size_t i = 0; i < words.size(); i += step) probes.push_back(words[i]);
  std::vector<std::uint32_t> all(units.size());
  std::iota(all.begin(), all.end(), 0U);
  const CostMatrix costs = scheme.costs(units, all, probes);
  std::vector<float> cheapest(units.size(), kInfeasible);
  for (std::uint32_t word = 0; word < costs.words; ++word) {
    const auto column = costs.column(word);
    for (std::size_t i = 0; i < cheapest.size(); ++i) {
      cheapest[i] = std::min(cheapest[i], column[i]);
    }
  }
  return cheapest;
}

// Returns the units without the most expensive `share` of them.
UnitSet without_dearest(const UnitSet& units, const std::vector<float>& costs, double share) {
  std::vector<std::uint32_t> order(units.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return costs[a] < costs[b]; });
  order.resize(units.size() - static_cast<std::size_t>(share * static_cast<double>(units.size())));
  std::sort(order.begin(), order.end());
  UnitSet kept;
  for (const std::uint32_t unit : order) {
    kept.anchors.push_back(units.anchors[unit]);
    kept.moved.append(units.moved[unit]);
    if (units.read.size() == units.size()) kept.read.append(units.read[unit]);
  }
  return kept;
}

}  // namespace

Capacity find_capacity(const Surface& surface, const BoundScheme& scheme,
                       std::span<const Word> words, const MarkOptions& options) {
  const double dropped = options.drop_dearest_percent / 100;
  if (!(dropped >= 0 && dropped < 1)) {
    throw Error(ErrorCode::Usage, {}, "",
                "the share of candidates left out is 0 to below 100 percent");
  }
  Capacity capacity;
  capacity.units = scheme.find_units();
  if (dropped > 0 && capacity.units.size() > 0) {
    const std::vector<float> costs =
        cheapest_costs(scheme, capacity.units, words, options.format.is_spread);
    capacity.units = without_dearest(capacity.units, costs, dropped);
  }
  const Conflicts conflicts(capacity.units.moved, capacity.units.read_or_moved(),
                            surface.mesh.positions.size(), options.conflict_rule);
  capacity.valid = choose_layout(conflicts, options.layout);
  capacity.bound = layout_bound(conflicts);
  return capacity;
}

}  // namespace triglyph
