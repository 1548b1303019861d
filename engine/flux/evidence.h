// What a sum of cosines proves.
#pragma once

#include <cstddef>

namespace triglyph {

// Returns minus the binary logarithm of the Chernoff bound of the probability that `count` cosines
// of independent uniform phases add up to `sum` or more; 0 for sums that are not positive.
[[nodiscard]] double cosine_evidence(double sum, std::size_t count);

}  // namespace triglyph
