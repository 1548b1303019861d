// How a mark is encoded in a mesh.
#pragma once

#include <string>
#include <string_view>

#include "engine/base/options.h"
#include "engine/message/words.h"

namespace triglyph {

// The encoding of the flux layer by name.
inline constexpr std::string_view kFluxScheme = "flux";

// All that a reader must know besides the key.
struct Encoding {
  // of units, or "flux", which has no format and no options
  std::string scheme = "tsq";
  WordFormat format;
  OptionValues scheme_options;  // all options of the scheme

  bool operator==(const Encoding&) const = default;
};

}  // namespace triglyph
