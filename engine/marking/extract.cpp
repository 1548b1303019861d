#include "engine/marking/extract.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/flux/flux_mark.h"
#include "engine/message/decode.h"
#include "engine/scheme/registry.h"

namespace triglyph {
namespace {

// Words that chance repeats so seldom in a sample point to a mark; reading all of the mesh for
// nothing once in a hundred times costs little.
constexpr double kFewByChance = 0.01;

// Powers of the readings' weights under which a spread message is decoded, one after the other.
// Noise moves invariants away from the centres of their cells, so that their distances tell little
// and all votes count alike. Of a piece that was cut out few units are left among many false ones,
// but they are exact: the sharper the weights, the better. Of 71 marks of eleven meshes of 6,000 to
// 23,000 points, 36 were read after noise of 0.1 % and 43 after a loss of 30 %; with the weights as
// they are, fewer.
constexpr std::array<double, 2> kSpreadPowers = {0, 6};

struct Counted {
  Votes votes;
  Decoded decoded;
};

Counted count(std::span<const Reading> readings, const WordCode& code, int doubtful_parts,
              double power) {
  Votes votes(code);
  for (Reading reading : readings) {
    reading.weight = static_cast<float>(std::pow(double{reading.weight}, power));
    votes.add(reading);
  }
  Decoded decoded = decode(votes, code, doubtful_parts);
  return {std::move(votes), std::move(decoded)};
}

Extraction extract_from(std::vector<Reading> readings, const WordCode& code, int doubtful_parts) {
  const bool is_spread = code.format().is_spread;
  Extraction result;
  result.readings = std::move(readings);
  Counted counted = count(result.readings, code, doubtful_parts, is_spread ? kSpreadPowers[0] : 1);
  result.false_alarm = counted.decoded.false_alarm;
  for (std::size_t i = 1; is_spread && i < kSpreadPowers.size() && !counted.decoded.message; ++i) {
    counted = count(result.readings, code, doubtful_parts, kSpreadPowers[i]);
    result.false_alarm += counted.decoded.false_alarm;  // every attempt can go wrong
  }
  result.message = std::move(counted.decoded.message);
  if (!result.message) return result;

  const std::vector<Word> words = code.words_of(*result.message);
  result.parts = least_units_for(code.format(), result.message->size());
  for (const Reading& reading : result.readings) {
    const std::uint32_t index = code.part_index(reading.word.subscript);
    if (index < words.size() && words[index] == reading.word) ++result.agreeing;
  }
  if (is_spread) {
    // parts need not be carried, but every reading is of one
    result.agreement =
        static_cast<double>(result.agreeing) / static_cast<double>(result.readings.size());
    return result;
  }
  result.agreement = 1;
  for (std::uint32_t index = 0; index < result.parts; ++index) {
    result.agreement = std::min(result.agreement, counted.votes.agreement(index));
  }
  return result;
}

}  // namespace

Extraction extract_as_is(const BoundScheme& scheme, const WordCode& code, int doubtful_parts) {
  return extract_from(scheme.read(), code, doubtful_parts);
}

Extraction extract(const BoundScheme& scheme, const WordCode& code, int doubtful_parts) {
  Extraction result = extract_as_is(scheme, code, doubtful_parts);
  if (result.message) return result;
  for (std::vector<Reading>& readings : scheme.read_turned_over()) {
    Extraction turned = extract_from(std::move(readings), code, doubtful_parts);
    result.false_alarm += turned.false_alarm;
    if (!turned.message) continue;
    turned.false_alarm = result.false_alarm;
    return turned;
  }
  return result;
}

bool has_repeated_words(std::span<const Reading> readings, const WordFormat& format) {
  std::vector<std::uint64_t> words;
  words.reserve(readings.size());
  for (const Reading& reading : readings) {
    words.push_back(std::uint64_t{reading.word.subscript} << 32 | reading.word.part);
  }
  std::sort(words.begin(), words.end());
  // the expected number of words that random readings hold `repeats` times or more
  const double all = std::ldexp(1.0, format.subscript_bits + format.part_bits);
  const double mean = static_cast<double>(words.size()) / all;
  double expected = all * mean;
  std::size_t repeats = 1;
  while (expected > kFewByChance || repeats < 2) {
    ++repeats;
    expected *= mean / static_cast<double>(repeats);
  }
  for (std::size_t i = repeats - 1; i < words.size(); ++i) {
    if (words[i] == words[i + 1 - repeats]) return true;
  }
  return false;
}

Extraction extract(const Surface& surface, const Encoding& encoding, const Key& key) {
  if (encoding.scheme == kFluxScheme) {
    Extraction result;
    result.flux = read_flux(surface, key);
    result.false_alarm = std::exp2(-kBelieved);
    if (result.flux) {
      result.message = message_in(result.flux->payload);
      result.false_alarm = std::exp2(-result.flux->evidence);
    }
    return result;
  }
  const WordCode code(key, encoding.format);
  const auto scheme = make_scheme(encoding.scheme, code, encoding.scheme_options);
  return extract(*scheme->bind(surface), code, doubtful_parts(encoding.scheme_options));
}

}  // namespace triglyph
