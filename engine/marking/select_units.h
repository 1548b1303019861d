// Step 1 of the paper on a mesh: which units there are.
// Wang & Hu, CAGD 27 (2010), section 2.1; leaving out dear candidates is ours.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/marking/options.h"

namespace triglyph {

// So many words tell a candidate's cheapest cost well enough.
inline constexpr std::uint32_t kProbeWords = 16;

struct Capacity {
  UnitSet units;                     // candidates, without those left out
  std::vector<std::uint32_t> valid;  // units that do not interfere, ascending
  std::uint32_t bound = 0;           // no layout has more
};

// `words`: those that are to be hidden, or some like them; used only to leave out dear candidates.
// `scheme` is bound to `surface`. Throws Error Usage if MarkOptions::drop_dearest_percent lies
// outside 0 up to 100.
[[nodiscard]] Capacity find_capacity(const Surface& surface, const BoundScheme& scheme,
                                     std::span<const Word> words, const MarkOptions& options);

}  // namespace triglyph
