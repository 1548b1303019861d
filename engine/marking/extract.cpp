#include "engine/marking/extract.h"

#include <algorithm>

#include "engine/message/decode.h"

namespace triglyph {

Extraction extract(const BoundScheme& scheme, const WordCode& code, int doubtful_parts) {
  Extraction result;
  result.readings = scheme.read();
  Votes votes(code);
  for (const Reading& reading : result.readings) votes.add(reading);
  Decoded decoded = decode(votes, code, doubtful_parts);
  result.message = std::move(decoded.message);
  result.false_alarm = decoded.false_alarm;
  if (!result.message) return result;

  const std::vector<Word> words = code.words_of(*result.message);
  result.parts = static_cast<std::uint32_t>(words.size());
  for (const Reading& reading : result.readings) {
    const std::uint32_t index = code.part_index(reading.word.subscript);
    if (index < words.size() && words[index] == reading.word) ++result.agreeing;
  }
  result.agreement = 1;
  for (std::uint32_t index = 0; index < result.parts; ++index) {
    result.agreement = std::min(result.agreement, votes.agreement(index));
  }
  return result;
}

}  // namespace triglyph
