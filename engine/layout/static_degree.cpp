#include <algorithm>
#include <numeric>

#include "engine/layout/layout.h"
#include "engine/layout/random_order.h"

namespace triglyph {

std::vector<std::uint32_t> static_degree_layout(const Conflicts& conflicts,
                                                const LayoutOptions& /*options*/) {
  const std::vector<std::uint32_t> degrees = degrees_of(conflicts);
  std::vector<std::uint32_t> order(conflicts.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return degrees[a] < degrees[b]; });
  return fit_in_order(conflicts, order);
}

}  // namespace triglyph
