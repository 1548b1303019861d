#include <numeric>

#include "engine/layout/layout.h"
#include "engine/layout/random_order.h"

namespace triglyph {

std::vector<std::uint32_t> first_fit_layout(const Conflicts& conflicts,
                                            const LayoutOptions& /*options*/) {
  std::vector<std::uint32_t> order(conflicts.size());
  std::iota(order.begin(), order.end(), 0U);
  return fit_in_order(conflicts, order);
}

}  // namespace triglyph
