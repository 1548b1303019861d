// The options of TSQ, and what applies unless the user says otherwise.
#pragma once

#include "engine/message/words.h"
#include "engine/scheme/scheme_options.h"

namespace triglyph {

struct TsqOptions : SchemeOptions {
  // A message's cells survive six significant digits; with fill they need only survive float32.
  [[nodiscard]] static TsqOptions defaults(bool fill) { return {{.step = fill ? 0.004 : 0.02}}; }
  // Eight subscript bits number the parts of a message of 256 bytes, the longest. With fill the
  // subscript gets as many bits as tell the units apart, at most these.
  [[nodiscard]] static WordFormat format(bool fill) {
    return fill ? WordFormat{6, 13, 9} : WordFormat{6, 8, 9};
  }
  static constexpr bool kHasFewUnits = false;

  [[nodiscard]] static OptionTable<TsqOptions> table() { return {step_option<TsqOptions>(0.5)}; }
};

}  // namespace triglyph
