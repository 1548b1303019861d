// Embree's device, of which a process needs one.
#pragma once

#include <embree3/rtcore.h>

namespace triglyph {

// note: never made with rtcNewDevice("threads=..."), which would throttle TBB for every other mesh.
// Throws std::logic_error if Embree offers none.
[[nodiscard]] RTCDevice embree_device();

}  // namespace triglyph
