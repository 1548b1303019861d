// Marking a mesh. Layout chooses the units, assignment the watermark word that each of them
// carries; either step can be switched off.
// Wang & Hu, CAGD 27 (2010), section 2 and figure 2.
#pragma once

#include "engine/marking/marking.h"
#include "engine/marking/options.h"
#include "engine/message/key.h"

namespace triglyph {

// Marks a mesh with a message, or fills it. `number_step`, in model units, is the distance between
// neighbouring numbers of the output; it tells a mesh that is too small from a file that is too
// coarse. Units are only where `recut` leaves the triangles as they are. Does not change the
// surface, and does not read the mark back. Throws Error Usage for a message that is empty, longer
// than 256 bytes or in need of more parts than the subscript bits number, and for options out of
// range. O(triangles + units * parts) plus the assignment.
[[nodiscard]] Marking mark(const Surface& surface, const Payload& payload, const Key& key,
                           const MarkOptions& options, const Rounding& rounding, double number_step,
                           const Recut& recut = {});

struct MarkTask;

// Returns the message that the task's mesh carries already in one of its layers, unless the task
// marks it anyway.
[[nodiscard]] std::optional<FoundMessage> mark_before(const MarkTask& task);

}  // namespace triglyph
