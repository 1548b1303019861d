// Readings of units as an extractor would return them.
#pragma once

#include "engine/message/votes.h"

namespace triglyph::test {

// Returns a unit's reading with all bits in the middle of their cells.
inline Reading reading_of(const Word& word, float weight) {
  Reading reading;
  reading.word = word;
  reading.weight = weight;
  reading.bit_weights.fill(1);
  return reading;
}

}  // namespace triglyph::test
