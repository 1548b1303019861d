// Why a mesh is not marked, and the way out, in words.
#pragma once

#include <cstdint>
#include <string>

#include "engine/marking/marking.h"
#include "engine/marking/options.h"

namespace triglyph {

// Returns one line for a marking that failed: the reason, with the values seen, and what helps.
// Precondition: the status is not Marked, and the marking was made as `request` says.
[[nodiscard]] std::string refusal(const Marking& marking, const MarkRequest& request,
                                  double number_step);

// Returns one line for a mesh whose mark could be read from `found` of so many units, too few.
// `triangles_would_do`: it could be read with the polygons cut into the triangles that were marked.
[[nodiscard]] std::string not_read_back(std::uint32_t found, std::uint32_t units,
                                        bool triangles_would_do);

// Returns one line for a mesh whose fingerprint leaves too few bits of evidence.
[[nodiscard]] std::string too_little_evidence(double bits, double needed);

// Returns one line for a mesh that did not get the memory that it takes by estimate_memory(): the
// estimate, and how a run leaves it all there is.
[[nodiscard]] std::string too_little_memory(std::uint64_t estimate);

}  // namespace triglyph
