#include "engine/message/fingerprint.h"

#include <string>

#include "engine/base/error.h"
#include "engine/base/random.h"

namespace triglyph {
namespace {

// Streams of the random numbers of a seed are the layers; that of the biases lies beyond.
constexpr std::uint64_t kBiases = 256;

}  // namespace

// The biases are the points of the Gauss-Legendre quadrature on [0, 1] with as many points as half
// the colluders, which Nuida et al. prove optimal; each with its probability, their table 1.
FingerprintCode::FingerprintCode(const Key& key, int colluders) : key_(key), colluders_(colluders) {
  if (colluders < 1 || colluders > kMostColluders) {
    throw Error(ErrorCode::Usage, {}, "",
                "fingerprints resist 1 to " + std::to_string(kMostColluders) + " colluders, not " +
                    std::to_string(colluders));
  }
  if (colluders <= 2) {
    points_ = {{0.5, 1}};
  } else if (colluders <= 4) {
    points_ = {{0.21132, 0.5}, {0.78868, 1}};
  } else if (colluders <= 6) {
    points_ = {{0.11270, 0.33201}, {0.5, 0.66799}, {0.88730, 1}};
  } else {
    points_ = {{0.06943, 0.24833}, {0.33001, 0.5}, {0.66999, 0.75167}, {0.93057, 1}};
  }
  const std::vector<std::uint8_t> bytes = key.stream(KeyUse::CopyBias, 8);
  for (const std::uint8_t byte : bytes) bias_seed_ = bias_seed_ << 8 | byte;
}

FingerprintSeed FingerprintCode::seed_of(std::span<const std::uint8_t> name) const {
  return key_.copy_seed(name);
}

double FingerprintCode::bias(FingerprintLayer layer, std::uint32_t bit) const {
  const double draw = random_unit(bias_seed_, kBiases + static_cast<std::uint64_t>(layer), bit);
  std::size_t at = 0;
  while (at + 1 < points_.size() && draw >= points_[at].until) ++at;
  return points_[at].bias;
}

std::uint64_t FingerprintCode::draw_of(FingerprintSeed seed, FingerprintLayer layer) {
  return mix_bits(mix_bits(seed) ^ static_cast<std::uint64_t>(layer));
}

std::uint32_t FingerprintCode::fair_symbol(FingerprintSeed seed, FingerprintLayer layer,
                                           std::uint32_t symbol, int bits) const {
  return fair_symbol(draw_of(seed, layer), symbol, bits);
}

std::uint32_t FingerprintCode::symbol(FingerprintSeed seed, FingerprintLayer layer,
                                      std::uint32_t symbol, int bits) const {
  if (is_fair()) return fair_symbol(seed, layer, symbol, bits);
  const auto stream = static_cast<std::uint64_t>(layer);
  std::uint32_t value = 0;
  for (int i = 0; i < bits; ++i) {
    const auto bit = symbol * static_cast<std::uint32_t>(bits) + static_cast<std::uint32_t>(i);
    if (random_unit(seed, stream, bit) < bias(layer, bit)) value |= 1U << i;
  }
  return value;
}

}  // namespace triglyph
