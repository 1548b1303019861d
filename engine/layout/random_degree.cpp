#include <algorithm>

#include "engine/base/parallel.h"
#include "engine/layout/budget.h"
#include "engine/layout/random_order.h"

namespace triglyph {
namespace {

constexpr std::size_t kBatch = 8;  // restarts at a time; fixed, so threads do not change the result

}  // namespace

std::vector<std::uint32_t> random_degree_layout(const Conflicts& conflicts,
                                                const LayoutOptions& options) {
  const Budget budget(options);
  std::vector<double> attraction;
  for (const std::uint32_t degree : degrees_of(conflicts)) attraction.push_back(1.0 / (1 + degree));

  std::vector<std::uint32_t> best;
  for (std::uint64_t done = 0; done == 0 || budget.allows(done); done += kBatch) {
    std::vector<std::vector<std::uint32_t>> layouts(kBatch);
    parallel_for(kBatch, [&](std::size_t i) {
      layouts[i] = fit_in_order(conflicts, draw_order(attraction, options.seed, done + i));
    });
    for (auto& layout : layouts) {
      if (layout.size() > best.size()) best = std::move(layout);
    }
  }
  return best;
}

}  // namespace triglyph
