#include "engine/marking/extract.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

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

Votes votes_of(std::span<const Reading> readings, const WordCode& code, double power) {
  Votes votes(code);
  for (Reading reading : readings) {
    if (power != 1) reading.weight = static_cast<float>(std::pow(double{reading.weight}, power));
    votes.add(reading);
  }
  return votes;
}

Counted count_directly(std::span<const Reading> readings, const WordCode& code,
                       int doubtful_parts) {
  if (!code.format().is_spread) {
    Votes votes = votes_of(readings, code, 1);
    Decoded decoded = decode(votes, code, doubtful_parts);
    return {std::move(votes), std::move(decoded)};
  }
  double false_alarm = 0;  // every attempt can go wrong
  for (std::size_t i = 0;; ++i) {
    Votes votes = votes_of(readings, code, kSpreadPowers.at(i));
    Decoded decoded = decode(votes, code, doubtful_parts);
    false_alarm += decoded.false_alarm;
    decoded.false_alarm = false_alarm;
    if (decoded.message || i + 1 == kSpreadPowers.size()) {
      return {std::move(votes), std::move(decoded)};
    }
  }
}

Counted count_and_correct(std::span<const Reading> readings, const WordCode& code) {
  Votes votes = votes_of(readings, code, 1);
  Decoded decoded = correct(votes, code);
  return {std::move(votes), std::move(decoded)};
}

// Completes the result by the message that was counted.
void tell(Counted counted, const WordCode& code, Extraction& result) {
  result.message = std::move(counted.decoded.message);
  const std::vector<Word> words =
      code.words_of(*result.message, code.most_words(result.message->size()));
  result.parts = least_units_for(code.format(), result.message->size());
  for (const Reading& reading : result.readings) {
    const std::uint32_t index = code.part_index(reading.word.subscript);
    if (index < words.size() && words[index] == reading.word) ++result.agreeing;
  }
  if (code.format().is_spread) {
    // parts need not be carried, but every reading is of one
    result.agreement =
        static_cast<double>(result.agreeing) / static_cast<double>(result.readings.size());
    return;
  }
  result.agreement = 1;
  for (std::uint32_t index = 0; index < result.parts; ++index) {
    result.agreement = std::min(result.agreement, counted.votes.agreement(index));
  }
}

// Tries readings of a surface, one way after the other, until one gives a message; the probability
// of a false alarm grows by each attempt.
class Attempts {
 public:
  explicit Attempts(const WordCode& code) : code_(code) {}

  // Each returns whether the readings give a message, which the result then tells.
  bool read_directly(std::vector<Reading>& readings, int doubtful_parts) {
    return take(count_directly(readings, code_, doubtful_parts), readings);
  }
  bool correct(std::vector<Reading>& readings) {
    return take(count_and_correct(readings, code_), readings);
  }

  // Ends the attempts. Without a message the result has these readings.
  [[nodiscard]] Extraction result(std::vector<Reading> otherwise) && {
    if (!result_.message) result_.readings = std::move(otherwise);
    return std::move(result_);
  }

 private:
  bool take(Counted counted, std::vector<Reading>& readings) {
    result_.false_alarm += counted.decoded.false_alarm;
    if (!counted.decoded.message) return false;
    result_.readings = std::move(readings);
    tell(std::move(counted), code_, result_);
    return true;
  }

  const WordCode& code_;
  Extraction result_;
};

}  // namespace

Extraction extract_as_is(const BoundScheme& scheme, const WordCode& code, int doubtful_parts) {
  Attempts attempts(code);
  std::vector<Reading> readings = scheme.read();
  if (!attempts.read_directly(readings, doubtful_parts) &&
      has_repeated_words(readings, code.format())) {
    attempts.correct(readings);
  }
  return std::move(attempts).result(std::move(readings));
}

Extraction extract(const BoundScheme& scheme, const WordCode& code, int doubtful_parts,
                   ReadEffort effort) {
  const bool is_spread = code.format().is_spread;
  if (is_spread && effort == ReadEffort::Direct) return {};
  Attempts attempts(code);
  std::vector<Reading> as_it_is = scheme.read();
  std::optional<std::vector<std::vector<Reading>>> turned;
  const auto try_all = [&](const auto& attempt) {
    if (attempt(as_it_is)) return true;
    if (!turned) turned = scheme.read_turned_over();
    return std::any_of(turned->begin(), turned->end(), attempt);
  };
  const auto directly = [&](int doubtful) {
    return try_all([&](auto& readings) { return attempts.read_directly(readings, doubtful); });
  };
  const auto try_effort = [&] {
    if (effort != ReadEffort::Correct && !is_spread && directly(0)) return;
    if (effort == ReadEffort::Direct) return;
    if ((is_spread || doubtful_parts > 0) && directly(doubtful_parts)) return;
    if (!is_spread) try_all([&](auto& readings) { return attempts.correct(readings); });
  };
  try_effort();
  return std::move(attempts).result(std::move(as_it_is));
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

Extraction extract(const Surface& surface, const Encoding& encoding, const Key& key,
                   ReadEffort effort) {
  if (encoding.scheme == kFluxScheme) {
    Extraction result;
    result.flux = read_flux(surface, key,
                            effort == ReadEffort::Direct ? FluxEffort::AsItIs : FluxEffort::All);
    result.false_alarm = std::exp2(-kBelieved);
    if (result.flux) {
      result.message = message_in(result.flux->payload);
      result.false_alarm = std::exp2(-result.flux->evidence);
    }
    return result;
  }
  const WordCode code(key, encoding.format);
  const auto scheme = make_scheme(encoding.scheme, code, encoding.scheme_options);
  return extract(*scheme->bind(surface), code, doubtful_parts(encoding.scheme_options), effort);
}

}  // namespace triglyph
