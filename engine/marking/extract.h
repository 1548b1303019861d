// Blind extraction of a message, from the mesh and the key alone.
// Inverse of Wang & Hu, CAGD 27 (2010), figures 1 and 2.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/flux/flux_reading.h"
#include "engine/marking/options.h"
#include "engine/message/key.h"
#include "engine/message/votes.h"
#include "engine/message/words.h"
#include "engine/scheme/scheme.h"

namespace triglyph {

struct Extraction {
  std::optional<Message> message;  // nothing: no mark under this key
  std::uint32_t parts = 0;         // parts of the message, or of a spread one the units that carry
                                   // it at least; 0 without a message
  std::uint32_t agreeing = 0;      // units whose word is exactly that of the message
  double agreement = 0;            // least agreement of the votes over all parts, 0 to 1; of a
                                   // spread message the share of the units that agree
  double false_alarm = 0;          // probability that an unmarked mesh yields a message
  std::vector<Reading> readings;   // all units with the marker, genuine or by chance; without a
                                   // message those of the surface as it is
  // The flux layer, read under the encoding "flux" alone; with it `message` may be missing, since a
  // number stands for one.
  std::optional<FluxFound> flux;
};

// What a reader tries. Who looks for marks of many kinds tries what is quick and surest for all of
// them first.
enum class ReadEffort : std::uint8_t {
  Direct,   // what a mark says that is as it was made, or lost units but no part; nothing of a
            // spread message, which is always corrected
  Correct,  // only what else it may say: of flux all hypotheses
  All,      // both, the first first
};

// Extracts with a scheme that is bound to the surface, also if the surface was turned inside out or
// mirrored since it was marked: that is tried if the surface as it is shows no message, and adds to
// the probability of a false alarm. `doubtful_parts` is as in decode(). O(triangles).
[[nodiscard]] Extraction extract(const BoundScheme& scheme, const WordCode& code,
                                 int doubtful_parts = 0, ReadEffort effort = ReadEffort::All);

// Extracts from the surface as it is alone. Corrects only what looks like a mark.
[[nodiscard]] Extraction extract_as_is(const BoundScheme& scheme, const WordCode& code,
                                       int doubtful_parts = 0);

// Extracts with the scheme and the word format of an encoding. Throws Error Usage for an unknown
// scheme or options out of range.
[[nodiscard]] Extraction extract(const Surface& surface, const Encoding& encoding, const Key& key,
                                 ReadEffort effort = ReadEffort::All);

// Says whether readings of a sample look like those of a mesh that carries a message, in which
// words repeat: some word is read more often than chance would let any be. Wrong in about one of a
// hundred unmarked meshes, more often in one whose parts repeat, and of messages with few units a
// part. O(readings).
[[nodiscard]] bool has_repeated_words(std::span<const Reading> readings, const WordFormat& format);

}  // namespace triglyph
