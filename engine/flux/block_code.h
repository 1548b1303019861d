// The code between a payload of 16 to 64 bits and the bits of the functionals, with soft decoding.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "engine/flux/lattice.h"
#include "engine/message/key.h"

namespace triglyph {

// What the bits of a payload are.
enum class FluxContent : std::uint8_t {
  Bytes,        // the message itself, its first byte in the lowest bits
  Number,       // Key::number() of a message that does not fit, as many bits of it as do
  Fingerprint,  // the bits of a fingerprint, without a payload: see FingerprintCode
};

// The contents of payloads.
inline constexpr std::array<FluxContent, 2> kFluxContents = {FluxContent::Bytes,
                                                             FluxContent::Number};

// Sizes of payloads, in bits: a mark takes the largest that the mesh can hold.
inline constexpr std::array<int, 4> kPayloadBits = {16, 24, 32, 64};

// What a flux mark carries.
struct FluxPayload {
  std::uint64_t value = 0;
  int bits = 0;  // one of kPayloadBits
  FluxContent content = FluxContent::Bytes;

  bool operator==(const FluxPayload&) const = default;
};

using FluxBits = std::array<std::uint8_t, kFunctionals>;

// Returns the phases that carry bits.
[[nodiscard]] FluxPhases phases_of(const FluxBits& bits);

// Soft values in order of their reliability, which all codes decode: preparing it once saves most
// of the time of a decoding that is given up soon.
class SoftOrder {
 public:
  explicit SoftOrder(const SoftBits& soft);

 private:
  friend class BlockCode;
  static constexpr std::size_t kBytes = (kFunctionals + 63) / 64 * 8;

  std::vector<std::size_t> functionals_;  // that say anything, the most reliable first
  std::vector<double> reliability_;       // of each of them, nats
  std::vector<bool> is_one_;              // the likelier bit
  double most_evidence_ = 0;
  // Sums of reliabilities over the set bits of a byte of a word.
  std::array<std::array<double, 256>, kBytes> sums_{};
};

// A random linear code over all functionals, plus a keyed word: marks that use fewer functionals
// have it punctured. Different sizes, contents and keys have independent keyed words, so a payload
// is never read as one of another kind.
class BlockCode {
 public:
  // Precondition: 1 <= bits <= 64.
  BlockCode(const Key& key, FluxContent content, int bits);

  [[nodiscard]] FluxContent content() const { return content_; }
  [[nodiscard]] int bits() const { return bits_; }

  // Returns the bits of all functionals. Bits of the payload above bits() are ignored.
  [[nodiscard]] FluxBits encode(std::uint64_t payload) const;

  // Returns the payload whose word is likely the best for the soft values; nothing if fewer than
  // bits() functionals say anything that is independent, or if another word is nearly as good.
  // Ordered statistics decoding of order 2, or 3 for small payloads: O(bits^2 or bits^3). This work
  // is based on: Fossorier, Lin. Soft-decision decoding of linear block codes based on ordered
  // statistics. IEEE Transactions on Information Theory 41 (1995).
  // Words of less evidence than the least are not looked for.
  [[nodiscard]] std::optional<std::uint64_t> decode(
      const SoftOrder& soft,
      double least_evidence = -std::numeric_limits<double>::infinity()) const;

 private:
  FluxContent content_;
  int bits_;
  std::array<std::uint64_t, kFunctionals> columns_{};  // of the generator matrix
  FluxBits scramble_{};
};

}  // namespace triglyph
