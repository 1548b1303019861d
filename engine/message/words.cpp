#include "engine/message/words.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>
#include <utility>

#include "engine/base/error.h"
#include "engine/base/parallel.h"

namespace triglyph {
namespace {

constexpr std::size_t kOffsets = 16;  // more invariants than a unit of any scheme has
constexpr std::size_t kLengthBits = 8;
constexpr std::size_t kTagBits = 32;
// Bits that units must hold over those of a spread payload: random ones determine it, but not those
// of two units that share a subscript, and places without a mark add wrong ones.
constexpr double kSurplus = 1.6;

std::uint32_t low_bits(int count) {
  return static_cast<std::uint32_t>((std::uint64_t{1} << count) - 1);
}

std::vector<std::uint32_t> stream_words(const Key& key, KeyUse use, std::size_t count) {
  const std::vector<std::uint8_t> bytes = key.stream(use, 4 * count);
  std::vector<std::uint32_t> words(count);
  for (std::size_t i = 0; i < 4 * count; ++i) {
    words[i / 4] |= std::uint32_t{bytes[i]} << (8 * (i % 4));
  }
  return words;
}

// The message and its tag, without a length: readers know what length they try.
std::vector<std::uint8_t> spread_payload(std::span<const std::uint8_t> message, std::uint32_t tag) {
  std::vector<std::uint8_t> bytes(message.begin(), message.end());
  for (int i = 0; i < 4; ++i) bytes.push_back(static_cast<std::uint8_t>(tag >> (8 * i)));
  return bytes;
}

// Fisher-Yates; the 64-bit product maps a 32-bit word to [0, i] with negligible bias.
std::vector<std::uint32_t> keyed_permutation(const Key& key, std::uint32_t size) {
  const std::vector<std::uint32_t> draws = stream_words(key, KeyUse::Permutation, size);
  std::vector<std::uint32_t> order(size);
  std::iota(order.begin(), order.end(), 0U);
  for (std::uint32_t i = size - 1; i > 0; --i) {
    const auto j = static_cast<std::uint32_t>((std::uint64_t{draws[i]} * (i + 1)) >> 32);
    std::swap(order[i], order[j]);
  }
  return order;
}

// Returns the length byte, the message and the tag. Bits are taken from the least significant of
// each byte.
std::vector<std::uint8_t> payload_bytes(std::span<const std::uint8_t> message, std::uint32_t tag) {
  std::vector<std::uint8_t> bytes;
  bytes.push_back(static_cast<std::uint8_t>(message.size() - 1));
  bytes.insert(bytes.end(), message.begin(), message.end());
  for (int i = 0; i < 4; ++i) bytes.push_back(static_cast<std::uint8_t>(tag >> (8 * i)));
  return bytes;
}

// Returns the message of the least number of bytes that attempt() finds.
template <typename Attempt>
std::optional<Message> first_of_lengths(const Attempt& attempt) {
  std::array<std::optional<Message>, kMaxSpreadBytes> found;
  parallel_for(
      found.size(), [&](std::size_t i) { found[i] = attempt(i + 1); }, 1);
  for (std::optional<Message>& message : found) {
    if (message) return std::move(message);
  }
  return std::nullopt;
}

bool bit_at(std::span<const std::uint8_t> bytes, std::size_t bit) {
  return bit / 8 < bytes.size() && ((bytes[bit / 8] >> (bit % 8)) & 1) != 0;
}

}  // namespace

void validate(const WordFormat& format) {
  const auto out_of = [](int bits, int least, int most) { return bits < least || bits > most; };
  if (out_of(format.marker_bits, 0, 16) || out_of(format.subscript_bits, 1, 16)) {
    throw Error(ErrorCode::Usage, {}, "", "a marker takes 0 to 16 bits, a subscript 1 to 16");
  }
  if (out_of(format.part_bits, 2, 32)) {
    throw Error(ErrorCode::Usage, {}, "", "a part takes 2 to 32 bits");
  }
}

std::uint32_t parts_for(const WordFormat& format, std::size_t message_bytes) {
  if (format.is_spread) return 1U << format.subscript_bits;
  const std::size_t bits = kLengthBits + 8 * message_bytes + kTagBits;
  const auto part_bits = static_cast<std::size_t>(format.part_bits);
  return static_cast<std::uint32_t>((bits + part_bits - 1) / part_bits);
}

std::uint32_t least_units_for(const WordFormat& format, std::size_t message_bytes) {
  if (!format.is_spread) return parts_for(format, message_bytes);
  const auto bits = static_cast<double>(8 * message_bytes + kTagBits);
  return static_cast<std::uint32_t>(std::ceil(kSurplus * bits / format.part_bits));
}

void check_message(const WordFormat& format, std::size_t message_bytes) {
  if (message_bytes < kMinMessageBytes || message_bytes > kMaxMessageBytes) {
    throw Error(ErrorCode::Usage, {}, "",
                "a message has 1 to 256 bytes, not " + std::to_string(message_bytes));
  }
  if (format.is_spread && message_bytes > kMaxSpreadBytes) {
    throw Error(ErrorCode::Usage, {}, "",
                "a message in this encoding has 1 to " + std::to_string(kMaxSpreadBytes) +
                    " bytes, not " + std::to_string(message_bytes));
  }
  const std::uint32_t parts = parts_for(format, message_bytes);
  const std::uint32_t most = 1U << format.subscript_bits;
  if (parts > most) {
    throw Error(ErrorCode::Usage, {}, "",
                "the message needs " + std::to_string(parts) + " parts, but " +
                    std::to_string(format.subscript_bits) + " subscript bits number only " +
                    std::to_string(most) +
                    ": shorten it, or raise the subscript bits or the part bits");
  }
}

WordCode::WordCode(const Key& key, const WordFormat& format) : key_(key), format_(format) {
  validate(format);
  marker_ = stream_words(key, KeyUse::Marker, 1)[0] & low_bits(format.marker_bits);
  for (const std::uint32_t draw : stream_words(key, KeyUse::Offsets, kOffsets)) {
    offsets_.push_back(draw * 0x1.0p-32);
  }
  permutation_ = keyed_permutation(key, capacity());
  inverse_.resize(capacity());
  for (std::uint32_t part = 0; part < capacity(); ++part) inverse_[permutation_[part]] = part;
  keystream_ = stream_words(key, KeyUse::Keystream, capacity());
  row_seed_ = std::bit_cast<std::uint64_t>(offset(3));
}

std::uint32_t WordCode::whiten(std::uint32_t part, std::uint32_t index) const {
  return (part ^ keystream_[index]) & low_bits(format_.part_bits);
}

std::vector<Word> WordCode::words_of(std::span<const std::uint8_t> message) const {
  return words_of(message, parts_for(format_, message.size()));
}

std::vector<Word> WordCode::part_words(std::span<const std::uint8_t> message) const {
  const std::vector<std::uint8_t> payload = payload_bytes(message, key_.tag(message));
  const auto part_bits = static_cast<std::size_t>(format_.part_bits);
  std::vector<Word> words(parts_for(format_, message.size()));
  for (std::uint32_t index = 0; index < words.size(); ++index) {
    std::uint32_t part = 0;
    for (std::size_t bit = 0; bit < part_bits; ++bit) {
      if (bit_at(payload, index * part_bits + bit)) part |= 1U << bit;
    }
    words[index] = {permutation_[index], whiten(part, index)};
  }
  return words;
}

std::uint32_t WordCode::most_words(std::size_t message_bytes) const {
  if (format_.is_spread || message_bytes <= kMaxSpreadBytes) return capacity();
  return parts_for(format_, message_bytes);
}

std::vector<Word> WordCode::words_of(std::span<const std::uint8_t> message,
                                     std::uint32_t count) const {
  check_message(format_, message.size());
  std::vector<Word> words;
  if (!format_.is_spread) words = part_words(message);
  const std::uint32_t wanted = std::min(count, most_words(message.size()));
  const SpreadCode code(row_seed_, 8 * message.size() + kTagBits);
  const std::vector<std::uint8_t> payload = spread_payload(message, key_.tag(message));
  for (auto index = static_cast<std::uint32_t>(words.size()); index < wanted; ++index) {
    words.push_back(parity_word(code, payload, index));
  }
  return words;
}

Word WordCode::parity_word(const SpreadCode& code, std::span<const std::uint8_t> payload,
                           std::uint32_t index) const {
  const auto part_bits = static_cast<std::uint32_t>(format_.part_bits);
  std::uint32_t part = 0;
  for (std::uint32_t bit = 0; bit < part_bits; ++bit) {
    if (code.parity(payload, index * part_bits + bit)) part |= 1U << bit;
  }
  return {permutation_[index], whiten(part, index)};
}

std::optional<Message> WordCode::decoded(std::size_t message_bytes,
                                         std::span<const SoftParity> parities,
                                         std::span<const SoftBit> bits) const {
  const std::size_t payload_bits = 8 * message_bytes + kTagBits;
  if (parities.size() + bits.size() < payload_bits) return std::nullopt;
  const std::vector<std::uint8_t> payload =
      SpreadCode(row_seed_, payload_bits).decode(parities, bits);
  Message message(payload.begin(), payload.begin() + static_cast<std::ptrdiff_t>(message_bytes));
  if (payload != spread_payload(message, key_.tag(message))) return std::nullopt;
  return message;
}

std::vector<SoftParity> WordCode::unwhitened(std::span<const double> values) const {
  const auto part_bits = static_cast<std::uint32_t>(format_.part_bits);
  std::vector<SoftParity> known;
  for (std::uint32_t row = 0; row < values.size(); ++row) {
    if (values[row] == 0) continue;
    const bool is_flipped = (keystream_[row / part_bits] >> (row % part_bits) & 1) != 0;
    known.push_back({row, is_flipped ? -values[row] : values[row]});
  }
  return known;
}

std::optional<Message> WordCode::spread_message_of(std::span<const double> balances) const {
  const std::vector<SoftParity> known = unwhitened(balances);
  return first_of_lengths([&](std::size_t bytes) { return decoded(bytes, known, {}); });
}

std::optional<Message> WordCode::corrected_message_of(std::span<const double> evidence) const {
  const std::vector<SoftParity> known = unwhitened(evidence);
  return first_of_lengths([&](std::size_t bytes) -> std::optional<Message> {
    const std::uint32_t own_rows =
        static_cast<std::uint32_t>(format_.part_bits) * parts_for(format_, bytes);
    std::vector<SoftBit> bits;
    std::vector<SoftParity> parities;
    for (const SoftParity& read : known) {
      if (read.row >= own_rows) {
        parities.push_back(read);
      } else if (read.row >= kLengthBits && read.row < kLengthBits + 8 * bytes + kTagBits) {
        bits.push_back({read.row - kLengthBits, read.value});
      }
    }
    return decoded(bytes, parities, bits);
  });
}

std::vector<Word> WordCode::fill_words(std::uint32_t parts) const {
  if (parts > capacity()) {
    throw Error(ErrorCode::Usage, {}, "",
                std::to_string(parts) + " parts are more than the " + std::to_string(capacity()) +
                    " that the subscript bits number");
  }
  const std::vector<std::uint32_t> payload = stream_words(key_, KeyUse::Fill, parts);
  std::vector<Word> words(parts);
  for (std::uint32_t index = 0; index < parts; ++index) {
    words[index] = {permutation_[index], payload[index] & low_bits(format_.part_bits)};
  }
  return words;
}

std::optional<std::uint8_t> WordCode::byte_of(std::span<const std::optional<std::uint32_t>> parts,
                                              std::size_t byte) const {
  const auto part_bits = static_cast<std::size_t>(format_.part_bits);
  unsigned value = 0;
  for (std::size_t i = 0; i < 8; ++i) {
    const std::size_t bit = 8 * byte + i;
    const auto index = static_cast<std::uint32_t>(bit / part_bits);
    if (index >= parts.size() || !parts[index]) return std::nullopt;
    value |= ((whiten(*parts[index], index) >> (bit % part_bits)) & 1U) << i;
  }
  return static_cast<std::uint8_t>(value);
}

std::optional<std::uint32_t> WordCode::parts_wanted(
    std::span<const std::optional<std::uint32_t>> parts) const {
  const auto length = byte_of(parts, 0);
  if (!length) return std::nullopt;
  return parts_for(format_, *length + std::size_t{1});
}

std::optional<Message> WordCode::message_of(
    std::span<const std::optional<std::uint32_t>> parts) const {
  const auto length = byte_of(parts, 0);
  if (!length) return std::nullopt;
  Message message;
  for (std::size_t i = 0; i < *length + std::size_t{1}; ++i) {
    const auto byte = byte_of(parts, 1 + i);
    if (!byte) return std::nullopt;
    message.push_back(*byte);
  }
  std::uint32_t tag = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto byte = byte_of(parts, 1 + message.size() + i);
    if (!byte) return std::nullopt;
    tag |= std::uint32_t{*byte} << (8 * i);
  }
  if (tag != key_.tag(message)) return std::nullopt;
  return message;
}

}  // namespace triglyph
