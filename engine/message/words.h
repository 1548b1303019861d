// A message as watermark words. The payload is a length byte, the message and its keyed tag; it is
// whitened by the key's stream, cut into p parts, and part j travels with a permuted subscript and
// the marker that says "here is a unit".
// Framework of Wang & Hu, CAGD 27 (2010), section 2; length, tag and whitening are ours.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/message/key.h"

namespace triglyph {

using Message = std::vector<std::uint8_t>;

inline constexpr std::size_t kMinMessageBytes = 1;
inline constexpr std::size_t kMaxMessageBytes = 256;

// How the bits of one watermark word are shared out.
struct WordFormat {
  int marker_bits = 6;     // m
  int subscript_bits = 8;  // s: at most 2^s different parts
  int part_bits = 9;       // w

  bool operator==(const WordFormat&) const = default;
};

// Throws Error Usage if a count is out of its range: 0 <= m <= 16, 1 <= s <= 16 and 2 <= w <= 32.
void validate(const WordFormat& format);

// Returns the number of parts that a message of so many bytes is cut into:
// ceil((8 + 8 * bytes + 32) / w).
[[nodiscard]] std::uint32_t parts_for(const WordFormat& format, std::size_t message_bytes);

// Throws Error Usage if a message has not 1 to 256 bytes, or needs more parts than 2^s.
void check_message(const WordFormat& format, std::size_t message_bytes);

// One watermark word as its bits stand in the mesh; the marker is the same for all.
struct Word {
  std::uint32_t subscript = 0;
  std::uint32_t part = 0;

  bool operator==(const Word&) const = default;
};

// What the key says about words of one format.
class WordCode {
 public:
  WordCode(const Key& key, const WordFormat& format);

  [[nodiscard]] const WordFormat& format() const { return format_; }
  [[nodiscard]] std::uint32_t marker() const { return marker_; }
  [[nodiscard]] std::uint32_t capacity() const { return 1U << format_.subscript_bits; }

  // Keyed number in [0, 1) that shifts the cells of the `index`-th invariant of a unit.
  [[nodiscard]] double offset(std::size_t index) const { return offsets_.at(index); }

  // Returns the p words of a message. Throws Error Usage as check_message() does.
  [[nodiscard]] std::vector<Word> words_of(std::span<const std::uint8_t> message) const;

  // `parts` words of a random payload that the key determines: the paper's experiment, a message
  // as long as the capacity. Throws Error Usage if parts > 2^s.
  [[nodiscard]] std::vector<Word> fill_words(std::uint32_t parts) const;

  // Which part a subscript found in a mesh belongs to; always below 2^s.
  [[nodiscard]] std::uint32_t part_index(std::uint32_t subscript) const {
    return inverse_[subscript];
  }

  // Number of parts of the message whose first parts these are, by its length byte; nothing if a
  // part of that is.
  [[nodiscard]] std::optional<std::uint32_t> parts_wanted(
      std::span<const std::optional<std::uint32_t>> parts) const;

  // The message in the parts, or nothing if the length byte asks for more parts than are known or
  // the tag does not fit. A part is nothing if no unit voted for it.
  [[nodiscard]] std::optional<Message> message_of(
      std::span<const std::optional<std::uint32_t>> parts) const;

 private:
  [[nodiscard]] std::optional<std::uint8_t> byte_of(
      std::span<const std::optional<std::uint32_t>> parts, std::size_t byte) const;
  [[nodiscard]] std::uint32_t whiten(std::uint32_t part, std::uint32_t index) const;

  Key key_;
  WordFormat format_;
  std::uint32_t marker_ = 0;
  std::vector<double> offsets_;
  std::vector<std::uint32_t> permutation_;  // part -> subscript
  std::vector<std::uint32_t> inverse_;      // subscript -> part
  std::vector<std::uint32_t> keystream_;    // one word a part
};

}  // namespace triglyph
