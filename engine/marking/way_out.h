// What would help a mesh that cannot be marked as the user wants. Nothing is guessed: every advice
// was tried on the mesh.
#pragma once

#include "engine/marking/mark_stages.h"

namespace triglyph {

// Return what helps where some part of a message has no unit, or where no unit is left of fill.
// Takes as long as a few markings, on large meshes more. Precondition: `stages` were run to their
// end, or until the words were too many.
[[nodiscard]] WayOut way_out_of_too_small(const MarkTask& task, MarkStages& stages);

// Returns what helps where the numbers of the file are too coarse. Marks the mesh a few times.
[[nodiscard]] WayOut way_out_of_too_coarse(const MarkTask& task);

// Returns the value, above 0, rounded up to two significant digits: the double that these digits
// are read as.
[[nodiscard]] double rounded_up(double value);

}  // namespace triglyph
