// Reading a mark back, blind: from the mesh and the key alone.
// Inverse of Wang & Hu, CAGD 27 (2010), figures 1 and 2.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "engine/message/votes.h"
#include "engine/message/words.h"
#include "engine/scheme/scheme.h"

namespace triglyph {

struct Extraction {
  std::optional<Message> message;  // nothing: no mark under this key
  std::uint32_t parts = 0;         // parts of the message; 0 without one
  std::uint32_t agreeing = 0;      // units whose word is exactly the message's
  double agreement = 0;            // of the least agreed part's votes, 0 to 1
  std::vector<Reading> readings;   // all units that show the marker, genuine or by chance
};

// Chance that a mesh which was never marked under the key yields a message: one hypothesis a mesh,
// against a 32-bit tag.
inline constexpr double kFalseAlarmBound = 0x1.0p-32;

// O(triangles).
[[nodiscard]] Extraction extract(const Surface& surface, const Scheme& scheme,
                                 const WordCode& code);

}  // namespace triglyph
