// The process-wide Embree device.
#pragma once

#include <embree3/rtcore.h>

namespace triglyph {

// Returns the device, created on first use. Throws std::logic_error if Embree cannot create one.
// note: created without "threads=...", which would limit TBB for all other meshes of the process.
[[nodiscard]] RTCDevice embree_device();

}  // namespace triglyph
