#include "engine/layout/layout.h"

namespace triglyph {

std::vector<std::uint32_t> first_fit_layout(const Conflicts& conflicts) {
  std::vector<std::uint32_t> chosen;
  std::vector<char> blocked(conflicts.size(), 0);
  for (std::uint32_t unit = 0; unit < conflicts.size(); ++unit) {
    if (blocked[unit] != 0) continue;
    chosen.push_back(unit);
    conflicts.for_each_neighbour(unit, [&](std::uint32_t other) { blocked[other] = 1; });
  }
  return chosen;
}

}  // namespace triglyph
