// Random numbers as pure functions of (seed, stream, index). Without a generator's state, a result
// never depends on the order of computation. Not cryptographically secure: secrets come from
// Key::stream().
#pragma once

#include <cstdint>

namespace triglyph {

// SplitMix64's finaliser (Steele, Lea, Flood 2014): a bijection that mixes all 64 bits.
[[nodiscard]] constexpr std::uint64_t mix_bits(std::uint64_t x) noexcept {
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

// Returns 64 random bits.
[[nodiscard]] constexpr std::uint64_t random_bits(std::uint64_t seed, std::uint64_t stream,
                                                  std::uint64_t index) noexcept {
  return mix_bits(mix_bits(mix_bits(seed) ^ stream) ^ index);
}

// Returns a number uniform in [0, 1), with 53 random bits.
[[nodiscard]] constexpr double random_unit(std::uint64_t seed, std::uint64_t stream,
                                           std::uint64_t index) noexcept {
  return static_cast<double>(random_bits(seed, stream, index) >> 11) * 0x1.0p-53;
}

}  // namespace triglyph
