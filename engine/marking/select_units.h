// Step 1 of the paper on a mesh: the choice of the units.
// Wang & Hu, CAGD 27 (2010), section 2.1; leaving out expensive candidates is ours.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/marking/options.h"

namespace triglyph {

// Words from which the least cost of a candidate is estimated: enough to rank candidates, few
// enough to cost little.
inline constexpr std::uint32_t kProbeWords = 16;

struct Capacity {
  UnitSet units;                     // the candidates, without those left out
  std::vector<std::uint32_t> valid;  // the layout: units that do not interfere, ascending
  std::uint32_t bound = 0;           // upper bound of the size of any layout
};

// Returns the candidates of the surface and a layout of them. `words` are those to hide, or a
// sample of them; they serve only to leave out expensive candidates. Precondition: `scheme` is
// bound to `surface`. Throws Error Usage unless 0 <= MarkOptions::drop_dearest_percent < 100.
[[nodiscard]] Capacity find_capacity(const Surface& surface, const BoundScheme& scheme,
                                     std::span<const Word> words, const MarkOptions& options);

}  // namespace triglyph
