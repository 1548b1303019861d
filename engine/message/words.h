// Watermark words. A length byte, the message and its keyed tag are whitened with the key's stream
// and cut into p parts. A word is one part together with its permuted subscript; in the mesh it
// follows the marker, which identifies a unit.
// Framework of Wang & Hu, CAGD 27 (2010), section 2; length, tag and whitening are ours.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/message/key.h"
#include "engine/message/spread.h"

namespace triglyph {

using Message = std::vector<std::uint8_t>;

inline constexpr std::size_t kMinMessageBytes = 1;
inline constexpr std::size_t kMaxMessageBytes = 256;
// Of a message that is spread, or to which parities are added: readers try every length.
inline constexpr std::size_t kMaxSpreadBytes = 16;

// The numbers of bits that one unit carries.
struct WordFormat {
  int marker_bits = 6;     // m
  int subscript_bits = 8;  // s: at most 2^s parts
  int part_bits = 9;       // w
  // Every word carries parities of the whole payload (spread.h) instead of one of its parts.
  bool is_spread = false;

  bool operator==(const WordFormat&) const = default;
};

// Throws Error Usage if a count is out of its range: 0 <= m <= 16, 1 <= s <= 16 and 2 <= w <= 32.
void validate(const WordFormat& format);

// Returns the number of parts of a message,
// ceil((8 + 8 * bytes + 32) / w); or 2^s if it is spread.
[[nodiscard]] std::uint32_t parts_for(const WordFormat& format, std::size_t message_bytes);

// Returns the number of units without which a mesh cannot carry a message: one a part; or if it is
// spread, those that hold a quarter more bits than message and tag.
[[nodiscard]] std::uint32_t least_units_for(const WordFormat& format, std::size_t message_bytes);

// Throws Error Usage if a message does not have 1 to 256 bytes, or 16 if it is spread, or needs
// more than 2^s parts.
// Precondition: the format is valid.
void check_message(const WordFormat& format, std::size_t message_bytes);

// One watermark word as it is embedded, without the marker, which all words share.
struct Word {
  std::uint32_t subscript = 0;
  std::uint32_t part = 0;

  bool operator==(const Word&) const = default;
};

// Encoder and decoder of words of one format under one key.
class WordCode {
 public:
  // Throws Error Usage as validate() does. O(2^s).
  WordCode(const Key& key, const WordFormat& format);

  [[nodiscard]] const WordFormat& format() const { return format_; }
  [[nodiscard]] std::uint32_t marker() const { return marker_; }
  // Returns 2^s, the most parts that subscripts can number.
  [[nodiscard]] std::uint32_t capacity() const { return 1U << format_.subscript_bits; }

  // Returns the keyed shift, in [0, 1) cells, of the quantiser of a unit's `index`-th invariant.
  [[nodiscard]] double offset(std::size_t index) const { return offsets_.at(index); }

  // Returns the p words of a message, or 2^s if it is spread. Throws Error Usage as check_message()
  // does.
  [[nodiscard]] std::vector<Word> words_of(std::span<const std::uint8_t> message) const;

  // Returns the p words of a message and behind them others that carry parities of its bits
  // (spread.h), `count` in all, but no fewer than p and no more than most_words(). Throws as above.
  [[nodiscard]] std::vector<Word> words_of(std::span<const std::uint8_t> message,
                                           std::uint32_t count) const;

  // Returns the number of words that a message can have: 2^s, or p if it is longer than readers
  // correct.
  [[nodiscard]] std::uint32_t most_words(std::size_t message_bytes) const;

  // Returns `parts` words of random bits that the key determines, for the paper's experiment, in
  // which the message is as long as the capacity. Throws Error Usage if parts > 2^s.
  [[nodiscard]] std::vector<Word> fill_words(std::uint32_t parts) const;

  // Returns the index of the part that a subscript belongs to; below 2^s.
  [[nodiscard]] std::uint32_t part_index(std::uint32_t subscript) const {
    return inverse_[subscript];
  }

  // Returns the message whose parities agree best with the votes on the bits: `balances` holds w
  // sums of votes for each part, above 0 where the bit is set and 0 where nothing is known. Tries
  // each length; nothing if no tag is right. Precondition: the format is spread. Some tens of
  // milliseconds.
  [[nodiscard]] std::optional<Message> spread_message_of(std::span<const double> balances) const;

  // Returns the message whose bits and parities agree best with what is known of the bits of all
  // words: `evidence` holds w log-likelihood ratios for each part, above 0 where the bit is set.
  // Tries each length; nothing if no tag is right. Precondition: the format is not spread. Some
  // tens of milliseconds on one core, parallel.
  [[nodiscard]] std::optional<Message> corrected_message_of(std::span<const double> evidence) const;

  // Returns the number of parts of the message that starts with these parts, according to its
  // length byte; nothing if a part that holds a bit of the length is missing.
  [[nodiscard]] std::optional<std::uint32_t> parts_wanted(
      std::span<const std::optional<std::uint32_t>> parts) const;

  // Returns the message in the parts, or nothing if a part that it needs is missing or if the tag
  // is wrong. Missing parts, for which no unit voted, are nothing.
  [[nodiscard]] std::optional<Message> message_of(
      std::span<const std::optional<std::uint32_t>> parts) const;

 private:
  [[nodiscard]] std::optional<std::uint8_t> byte_of(
      std::span<const std::optional<std::uint32_t>> parts, std::size_t byte) const;
  [[nodiscard]] std::uint32_t whiten(std::uint32_t part, std::uint32_t index) const;
  [[nodiscard]] Word parity_word(const SpreadCode& code, std::span<const std::uint8_t> payload,
                                 std::uint32_t index) const;
  [[nodiscard]] std::vector<Word> part_words(std::span<const std::uint8_t> message) const;
  // Returns the values of bits, w for each part, as those before they were whitened; without zeros.
  [[nodiscard]] std::vector<SoftParity> unwhitened(std::span<const double> values) const;
  // Returns the message of so many bytes whose bits were read best, if its tag is right.
  [[nodiscard]] std::optional<Message> decoded(std::size_t message_bytes,
                                               std::span<const SoftParity> parities,
                                               std::span<const SoftBit> bits) const;

  Key key_;
  WordFormat format_;
  std::uint32_t marker_ = 0;
  std::vector<double> offsets_;
  std::vector<std::uint32_t> permutation_;  // part -> subscript
  std::vector<std::uint32_t> inverse_;      // subscript -> part
  std::vector<std::uint32_t> keystream_;    // one word per part
  std::uint64_t row_seed_ = 0;              // of the parities
};

}  // namespace triglyph
