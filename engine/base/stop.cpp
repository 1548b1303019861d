#include "engine/base/stop.h"

namespace triglyph {

const char* Stopped::what() const noexcept {
  return "interrupted";
}

namespace internal {

void throw_stopped() {
  throw Stopped();
}

}  // namespace internal

}  // namespace triglyph
