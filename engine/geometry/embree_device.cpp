#include "engine/geometry/embree_device.h"

#include <new>

#include "engine/base/error.h"

namespace triglyph {

RTCDevice embree_device() {
  // made again by the next caller if it throws
  static const struct Device {
    RTCDevice handle = rtcNewDevice(nullptr);
    Device() {
      if (handle != nullptr) return;
      if (rtcGetDeviceError(nullptr) == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
      check(false, "Embree offers no device");
    }
    ~Device() { rtcReleaseDevice(handle); }
  } device;
  return device.handle;
}

}  // namespace triglyph
