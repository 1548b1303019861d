// Hiding a message in a mesh: the paper's figure 2 on one page. Layout decides which units there
// are, assignment which watermark word each carries; either step can be switched off.
// Wang & Hu, CAGD 27 (2010), section 2.
#pragma once

#include <cstdint>
#include <span>

#include "engine/marking/marking.h"
#include "engine/marking/options.h"
#include "engine/message/key.h"

namespace triglyph {

// Marks a mesh with a message. Throws Error Usage for a message or options that cannot be. An empty
// message asks for the paper's experiment: a keyed random message as long as the capacity, one part
// a unit up to 2^13 units, repeated beyond. `number_step` is the distance between the numbers that
// the output can hold, model units, and explains a failure.
// O(triangles + units * parts) and the assignment.
[[nodiscard]] Marking mark(const Surface& surface, std::span<const std::uint8_t> message,
                           const Key& key, const MarkOptions& options, const Rounding& rounding,
                           double number_step);

}  // namespace triglyph
