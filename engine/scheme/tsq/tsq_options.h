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
  // Cells wide enough for noise of 0.15 %, and fewer bits in a unit, so that more units keep all of
  // theirs. Five subscript bits number the parts of a message of up to 27 bytes and, of up to 16,
  // as many again that carry parities.
  [[nodiscard]] static TsqOptions strong() { return {{.step = 0.15}}; }
  static constexpr WordFormat kStrongFormat{3, 5, 8};
  static constexpr bool kHasFewUnits = false;

  [[nodiscard]] static OptionTable<TsqOptions> table() { return {step_option<TsqOptions>(0.5)}; }
};

}  // namespace triglyph
