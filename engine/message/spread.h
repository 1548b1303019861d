// Words that carry parities of a payload, each of some bits that lie close together. Every word
// tells as much as any other, so that a place may fix the subscript; a few more bits than the
// payload has suffice, whichever they are, and each bit more corrects errors.
//
// This work is based on:
// Elias. Coding for noisy channels. IRE Convention Record 4 (1955): convolutional codes; here the
// taps of every parity are drawn at random, so that there are as many parities as one wants.
// Viterbi. Error bounds for convolutional codes and an asymptotically optimum decoding algorithm.
// IEEE Transactions on Information Theory 13 (1967).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace triglyph {

// A parity as it was read.
struct SoftParity {
  std::uint32_t row = 0;  // its number
  double value = 0;       // above 0: set, below 0: clear; the farther from 0, the surer
};

// A bit of the payload as it was read, with a value likewise.
struct SoftBit {
  std::size_t bit = 0;
  double value = 0;
};

class SpreadCode {
 public:
  // Of payloads of `bits` > 0 bits.
  SpreadCode(std::uint64_t seed, std::size_t bits) : seed_(seed), bits_(bits) {}

  // Returns the parity that a row draws of a payload, bit i of which is bit i % 8 of byte i / 8.
  [[nodiscard]] bool parity(std::span<const std::uint8_t> payload, std::uint32_t row) const;

  // Returns the payload that agrees best with the parities, and the bits of its own, that were
  // read: the sum of the values of those that are set, less that of those that are clear, is
  // greatest. Precondition: the bits read are below bits(). O(parities + bits * 12 * 2^12).
  [[nodiscard]] std::vector<std::uint8_t> decode(std::span<const SoftParity> parities,
                                                 std::span<const SoftBit> read = {}) const;

 private:
  // A parity is that of the bits end - i, for the bits i that are set in taps; those before the
  // first and after the last of the payload are 0.
  struct Row {
    std::size_t end = 0;
    std::uint32_t taps = 0;
  };
  [[nodiscard]] Row row_of(std::uint32_t row) const;
  [[nodiscard]] std::size_t steps() const;

  std::uint64_t seed_;
  std::size_t bits_;
};

}  // namespace triglyph
