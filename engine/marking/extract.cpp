#include "engine/marking/extract.h"

#include <algorithm>

#include "engine/message/decode.h"
#include "engine/scheme/registry.h"

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

Extraction extract(const Surface& surface, const Encoding& encoding, const Key& key) {
  const WordCode code(key, encoding.format);
  const auto scheme = make_scheme(encoding.scheme, code, encoding.scheme_options);
  return extract(*scheme->bind(surface), code, doubtful_parts(encoding.scheme_options));
}

}  // namespace triglyph
