// This work is based on:
// Leguizamon, Michalewicz, Schutz. An ant system for the maximum independent set problem (2001).
// Stutzle, Hoos. MAX-MIN ant system. Future Generation Computer Systems 16 (2000): only the best
// ant leaves a trail, and trails stay within bounds.
// Deviation: the visibility of a unit is 1 / (1 + degree) in the whole graph and not in what is
// left of it, so that one ant is a random order and a first fit.
#include <algorithm>

#include "engine/base/parallel.h"
#include "engine/layout/budget.h"
#include "engine/layout/random_order.h"

namespace triglyph {
namespace {

constexpr std::size_t kAnts = 8;      // per iteration; fixed, so threads do not change the result
constexpr double kEvaporation = 0.1;  // per iteration
// Least strength of a trail, relative to the greatest, so that every unit can still be drawn.
constexpr double kLeastTrail = 0.01;

void lay_trail(std::span<const std::uint32_t> layout, std::vector<double>& trail) {
  for (double& strength : trail) strength *= 1 - kEvaporation;
  for (const std::uint32_t unit : layout) trail[unit] += kEvaporation;
  for (double& strength : trail) strength = std::max(strength, kLeastTrail);
}

}  // namespace

std::vector<std::uint32_t> ant_colony_layout(const Conflicts& conflicts,
                                             const LayoutOptions& options) {
  const Budget budget(options);
  const std::vector<std::uint32_t> degrees = degrees_of(conflicts);
  std::vector<double> trail(conflicts.size(), 1);
  std::vector<double> attraction(conflicts.size());

  std::vector<std::uint32_t> best;
  for (std::uint64_t done = 0; done == 0 || budget.allows(done); done += kAnts) {
    for (std::size_t unit = 0; unit < trail.size(); ++unit) {
      attraction[unit] = trail[unit] / (1.0 + degrees[unit]);
    }
    std::vector<std::vector<std::uint32_t>> layouts(kAnts);
    parallel_for(kAnts, [&](std::size_t ant) {
      layouts[ant] = fit_in_order(conflicts, draw_order(attraction, options.seed, done + ant));
    });
    for (auto& layout : layouts) {
      if (layout.size() > best.size()) best = std::move(layout);
    }
    lay_trail(best, trail);
  }
  return best;
}

}  // namespace triglyph
