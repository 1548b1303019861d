// Why a mesh is not marked, and the way out, in words.
#pragma once

#include <string>

#include "engine/marking/marking.h"
#include "engine/marking/options.h"

namespace triglyph {

// Returns one line for a marking that failed: the reason, with the values seen, and what helps.
// Precondition: the status is not Marked, and the marking was made as `request` says.
[[nodiscard]] std::string refusal(const Marking& marking, const MarkRequest& request,
                                  double number_step);

}  // namespace triglyph
