// Reading a mark back, blind: from the mesh and the key alone.
// Inverse of Wang & Hu, CAGD 27 (2010), figures 1 and 2.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "engine/marking/options.h"
#include "engine/message/key.h"
#include "engine/message/votes.h"
#include "engine/message/words.h"
#include "engine/scheme/scheme.h"

namespace triglyph {

struct Extraction {
  std::optional<Message> message;  // nothing: no mark under this key
  std::uint32_t parts = 0;         // parts of the message; 0 without one
  std::uint32_t agreeing = 0;      // units whose word is exactly the message's
  double agreement = 0;            // of the least agreed part's votes, 0 to 1
  double false_alarm = 0;          // chance that an unmarked mesh yields a message
  std::vector<Reading> readings;   // all units that show the marker, genuine or by chance
};

// O(triangles).
[[nodiscard]] Extraction extract(const BoundScheme& scheme, const WordCode& code,
                                 int doubtful_parts = 0);

// The same with the scheme and the word format of an encoding. Throws Error Usage for one that
// cannot be.
[[nodiscard]] Extraction extract(const Surface& surface, const Encoding& encoding, const Key& key);

}  // namespace triglyph
