#include "engine/geometry/embree_device.h"

#include "engine/base/error.h"

namespace triglyph {

RTCDevice embree_device() {
  static const struct Device {
    RTCDevice handle = rtcNewDevice(nullptr);
    ~Device() { rtcReleaseDevice(handle); }
  } device;
  check(device.handle != nullptr, "Embree offers no device");
  return device.handle;
}

}  // namespace triglyph
