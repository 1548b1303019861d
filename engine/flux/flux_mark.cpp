#include "engine/flux/flux_mark.h"

#include <algorithm>

#include "engine/flux/flux_reading.h"
#include "engine/mesh/surface_diagonal.h"
#include "engine/metric/deformation.h"
#include "engine/metric/structural_distortion.h"

namespace triglyph {
namespace {

// Evidence, in bits beside those of the payload, that a mark must be expected to leave after usual
// noise: what is asked for, what a reader pays for its hypotheses, and a reserve for what is worse.
constexpr double kNeeded = kBelieved + 28;

// The least payload is also given to meshes of which a reader is sure only as long as little is
// done to them.
constexpr double kNeededAtLeast = kBelieved + 14;

// Likewise of a word that its reader knows, with nothing paid for a payload.
constexpr double kNeededOfWord = 54;

// Functionals a bit of the payload: a code of a higher rate confuses payloads.
constexpr double kLeastRedundancy = 1.6;

// How often a limit that is exceeded is met with smaller moves.
constexpr int kMostTrials = 5;

// Of the proportion by which a limit was exceeded; what is seen grows about linearly with the
// moves.
constexpr double kReserve = 0.95;

// The lowest limit that is tried, in relation to what was asked for.
constexpr double kLeastShareOfLimit = 0.1;

std::uint64_t low_bits(std::uint64_t value, int bits) {
  return value & ~std::uint64_t{0} >> (64 - bits);
}

// Returns the number of bits for the payload; 0 if a reader would not find the least.
int payload_bits(const FluxCanvas& canvas, const FluxLimits& limits, std::size_t message_bytes) {
  const auto step = canvas.expected_step(limits);
  if (!step) return 0;
  const FluxExpectation evidence = canvas.expected_evidence(*step);
  int most = 0;
  for (const int bits : kPayloadBits) {
    const bool is_least = bits == kPayloadBits.front();
    const bool is_redundant =
        static_cast<double>(canvas.used()) >= kLeastRedundancy * static_cast<double>(bits);
    const bool lasts = evidence.after_usual_noise >= bits + kNeeded ||
                       (is_least && evidence.after_little_noise >= bits + kNeededAtLeast);
    if (is_redundant && lasts) most = bits;
  }
  // a message that fits is carried itself, with the redundancy of a smaller code
  const auto own = static_cast<int>(8 * message_bytes);
  const bool is_size =
      std::find(kPayloadBits.begin(), kPayloadBits.end(), own) != kPayloadBits.end();
  return is_size && own <= most ? own : most;
}

struct WordToWrite {
  FluxPayload payload;
  FluxPhases phases;
};

// Writes the word that word_within(limits) returns with moves that keep within the bounds; nothing
// means that it would not be found.
template <typename WordWithin>
FluxMarking write_within(const Surface& surface, const FluxCanvas& canvas,
                         const WordWithin& word_within, const Key& key, const FluxBounds& bounds,
                         const std::function<Vec3(const Vec3&)>& rounding) {
  FluxMarking result;
  result.obstacle = canvas.obstacle();
  if (result.obstacle != FluxObstacle::None) return result;
  const std::vector<Vec3>& before = surface.mesh.positions;
  const double diagonal = surface_diagonal(surface.mesh);
  const Dither dither(key);
  FluxLimits limits{bounds.rms_percent};
  for (int trial = 0; trial < kMostTrials; ++trial) {
    const std::optional<WordToWrite> word = word_within(limits);
    if (!word) {
      result.obstacle = trial == 0 ? FluxObstacle::TooFaint : FluxObstacle::TooVisible;
      return result;
    }
    auto written = canvas.write(word->phases, dither, limits);
    if (!written) {
      result.obstacle = FluxObstacle::TooFaint;
      return result;
    }
    for (std::size_t i = 0; i < before.size(); ++i) {
      if (written->positions[i] != before[i]) {
        written->positions[i] = rounding(written->positions[i]);
      }
    }
    double excess = 0;  // of a limit, as a proportion
    if (bounds.max_percent > 0) {
      const double most = displacement(before, written->positions).max / diagonal * 100;
      excess = std::max(excess, most / bounds.max_percent);
    }
    if (bounds.visibility > 0) {
      const Mesh moved{written->positions, surface.mesh.triangles};
      excess = std::max(excess, msdm2(surface.mesh, moved, kWindowsSeen) / bounds.visibility);
    }
    if (excess <= 1) {
      result.mark = {word->payload, step_size(written->step), written->rms_percent,
                     canvas.expected_evidence(written->step).after_usual_noise,
                     static_cast<std::uint32_t>(canvas.used())};
      result.positions = std::move(written->positions);
      return result;
    }
    limits.rms_percent *= kReserve / excess;
    if (limits.rms_percent < kLeastShareOfLimit * bounds.rms_percent) break;
  }
  result.obstacle = FluxObstacle::TooVisible;
  return result;
}

}  // namespace

FluxPayload flux_payload(std::span<const std::uint8_t> message, const Key& key, int bits) {
  if (8 * message.size() != static_cast<std::size_t>(bits)) {
    return {low_bits(key.number(message), bits), bits, FluxContent::Number};
  }
  FluxPayload payload{0, bits, FluxContent::Bytes};
  for (std::size_t i = 0; i < message.size(); ++i) {
    payload.value |= std::uint64_t{message[i]} << (8 * i);
  }
  return payload;
}

std::optional<Message> message_in(const FluxPayload& payload) {
  if (payload.content != FluxContent::Bytes) return std::nullopt;
  return bytes_of(payload);
}

std::vector<std::uint8_t> bytes_of(const FluxPayload& payload) {
  std::vector<std::uint8_t> bytes;
  for (int bit = 0; bit < payload.bits; bit += 8) {
    bytes.push_back(static_cast<std::uint8_t>(payload.value >> bit));
  }
  return bytes;
}

bool stands_for(const FluxPayload& payload, std::span<const std::uint8_t> message, const Key& key) {
  return flux_payload(message, key, payload.bits) == payload;
}

std::string shown(const FluxPayload& payload) {
  if (payload.content == FluxContent::Fingerprint) return "a fingerprint";
  if (const auto message = message_in(payload)) return shown(*message);
  return "number " + to_hex(bytes_of(payload));
}

FluxMarking mark_flux(const Surface& surface, std::span<const std::uint8_t> message, const Key& key,
                      const FluxBounds& bounds, const std::function<Vec3(const Vec3&)>& rounding) {
  const FluxCanvas canvas(surface);
  const auto word_within = [&](const FluxLimits& limits) -> std::optional<WordToWrite> {
    const int bits = payload_bits(canvas, limits, message.size());
    if (bits == 0) return std::nullopt;
    const FluxPayload payload = flux_payload(message, key, bits);
    return WordToWrite{payload,
                       phases_of(BlockCode(key, payload.content, bits).encode(payload.value))};
  };
  return write_within(surface, canvas, word_within, key, bounds, rounding);
}

FluxMarking mark_flux_word(const Surface& surface, const FluxCanvas& canvas, const FluxPhases& word,
                           const Key& key, const FluxBounds& bounds,
                           const std::function<Vec3(const Vec3&)>& rounding) {
  const auto word_within = [&](const FluxLimits& limits) -> std::optional<WordToWrite> {
    const auto step = canvas.expected_step(limits);
    if (!step || canvas.expected_evidence(*step).after_little_noise < kNeededOfWord) {
      return std::nullopt;
    }
    const auto used = static_cast<int>(canvas.used());
    return WordToWrite{{0, used, FluxContent::Fingerprint}, word};
  };
  return write_within(surface, canvas, word_within, key, bounds, rounding);
}

}  // namespace triglyph
