// The options of AIE, and what applies unless the user says otherwise.
#pragma once

#include <array>
#include <string_view>

#include "engine/message/words.h"
#include "engine/scheme/scheme_options.h"

namespace triglyph {

// The neighbours of a basis that carry a group's bits.
enum class AieGroups {
  One,  // one a group: more units
  All,  // all that can be told apart: a group survives damage to some of its points
};

// The names by AieGroups.
inline constexpr std::array<std::string_view, 2> kAieGroupNames = {"one", "all"};

struct AieOptions : SchemeOptions {
  AieGroups groups = AieGroups::One;

  // The cells are as wide as those of TSQ.
  [[nodiscard]] static AieOptions defaults(bool fill) { return {{.step = fill ? 0.004 : 0.02}}; }
  [[nodiscard]] static WordFormat format(bool fill) {
    return fill ? WordFormat{6, 13, 5} : WordFormat{6, 8, 10};
  }
  // Wider cells would be seen long before they survived more than a little noise: a strong mark has
  // more units.
  [[nodiscard]] static AieOptions strong() { return defaults(false); }
  static constexpr WordFormat kStrongFormat{6, 8, 10};
  static constexpr bool kHasFewUnits = false;

  [[nodiscard]] static OptionTable<AieOptions> table() {
    return {step_option<AieOptions>(0.5),
            choice_option<AieOptions>("aie_groups", &AieOptions::groups, kAieGroupNames, "one",
                                      "Neighbours that carry a group's bits in aie")};
  }
};

}  // namespace triglyph
