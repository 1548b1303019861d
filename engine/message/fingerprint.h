// Fingerprints: words that differ from name to name, by which an owner who keeps a list of names
// tells whose copy a mesh is. Every bit is a secret random function of the key and the name; a
// reader who knows both knows every bit beforehand, so that a few dozen of them suffice where a
// message would need its length, its tag and all of its parts.
//
// This work is based on:
// Tardos. Optimal probabilistic fingerprint codes. Journal of the ACM 55 (2008): biased bits.
// Nuida, Fujitsu, Hagiwara, Kitagawa, Watanabe, Ogawa, Imai. An improvement of discrete Tardos
// fingerprinting codes. Designs, Codes and Cryptography 52 (2009): the biases for few colluders.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/random.h"
#include "engine/message/key.h"

namespace triglyph {

// What carries the bits of a fingerprint. The bits of different layers are independent. The values
// are fixed for good.
enum class FingerprintLayer : std::uint8_t { Units = 0, Flux = 1, Points = 2 };

inline constexpr int kMostColluders = 8;

// All bits of a name's fingerprint follow from its seed, which is secret.
using FingerprintSeed = std::uint64_t;

class FingerprintCode {
 public:
  // `colluders` are as many as may combine their copies: up to 2, every bit is fair; for more, it
  // is biased by the key such that colluders cannot agree on what nobody has. Throws Error Usage
  // unless 1 <= colluders <= kMostColluders.
  explicit FingerprintCode(const Key& key, int colluders = 1);

  [[nodiscard]] int colluders() const { return colluders_; }

  // Returns the seed of a name. O(bytes), about a microsecond.
  [[nodiscard]] FingerprintSeed seed_of(std::span<const std::uint8_t> name) const;

  // Returns the probability that a bit of a name that is drawn at random is set.
  [[nodiscard]] double bias(FingerprintLayer layer, std::uint32_t bit) const;
  [[nodiscard]] bool is_fair() const { return points_.size() == 1; }

  // Returns symbol number `symbol` of `bits` <= 32 bits each, all fair.
  [[nodiscard]] std::uint32_t fair_symbol(FingerprintSeed seed, FingerprintLayer layer,
                                          std::uint32_t symbol, int bits) const;

  // Likewise, for many symbols of one name: draw_of() once, then a symbol each in a nanosecond.
  [[nodiscard]] static std::uint64_t draw_of(FingerprintSeed seed, FingerprintLayer layer);
  [[nodiscard]] static std::uint32_t fair_symbol(std::uint64_t draw, std::uint32_t symbol,
                                                 int bits) {
    return static_cast<std::uint32_t>(mix_bits(draw ^ symbol) >> (64 - bits));
  }

  // Returns symbol number `symbol`, whose bits, symbol * bits and up, have the biases of the code.
  [[nodiscard]] std::uint32_t symbol(FingerprintSeed seed, FingerprintLayer layer,
                                     std::uint32_t symbol, int bits) const;

 private:
  struct Point {
    double bias;
    double until;  // cumulative probability of the bias
  };

  Key key_;
  int colluders_;
  std::vector<Point> points_;
  std::uint64_t bias_seed_ = 0;
};

}  // namespace triglyph
