// Step 1 of the paper: a large set of candidates that do not interfere, an independent set of the
// conflict graph. Its size is the capacity of the mesh.
// Wang & Hu, CAGD 27 (2010), section 2.1.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "engine/layout/conflicts.h"

namespace triglyph {

enum class LayoutMethod {
  FirstFit,   // un-optimised: every candidate, in order, that interferes with none taken before
  MinDegree,  // always the candidate with the fewest remaining neighbours
};

// "first-fit", "min-degree"; the inverse throws Error Usage.
[[nodiscard]] std::string_view name_of(LayoutMethod method);
[[nodiscard]] LayoutMethod layout_method(const std::string& name);

// Units of a maximal independent set, ascending.
[[nodiscard]] std::vector<std::uint32_t> choose_layout(const Conflicts& conflicts,
                                                       LayoutMethod method);

// O(total size of the units' neighbourhoods).
[[nodiscard]] std::vector<std::uint32_t> first_fit_layout(const Conflicts& conflicts);

// Greedy on dynamic degrees with a bucket queue, a neighbour counting once for every shared point;
// of equal degree, the unit that entered its bucket last. O(sum of degrees).
[[nodiscard]] std::vector<std::uint32_t> min_degree_layout(const Conflicts& conflicts);

// No independent set is larger: units move different points, so their sizes, smallest first, must
// fit into the points that candidates can move. O(units + points).
[[nodiscard]] std::uint32_t layout_bound(const Conflicts& conflicts);

}  // namespace triglyph
