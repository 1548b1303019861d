// The secret behind a mark, and everything that is derived from it. Whoever lacks the key can
// neither find the units (marker, offsets) nor order the parts (permutation) nor read them
// (keystream) nor forge a message (tag).
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace triglyph {

// What a derived stream of secret bytes is for; the values are fixed for good, since every marked
// file depends on them.
enum class KeyUse : std::uint64_t {
  Fingerprint = 0,
  Marker = 1,
  Offsets = 2,
  Permutation = 3,
  Keystream = 4,
  Tag = 5,
  Fill = 6,
};

class Key {
 public:
  static constexpr std::size_t kBytes = 32;

  // The public key used when none is given: anyone can read and forge marks made with it.
  [[nodiscard]] static Key trial();

  // 32 bytes from the system's random source.
  [[nodiscard]] static Key generate();

  // Reads what save() wrote. Throws Error: Unreadable (absent, a symbolic link, not a regular file,
  // or readable by group or others) or Malformed (not a key file, check digits wrong).
  [[nodiscard]] static Key load(const std::filesystem::path& path);

  // Creates the file with mode 0600. Throws Error Unwritable, also if it exists: a key is never
  // overwritten.
  void save(const std::filesystem::path& path) const;

  ~Key();
  Key(const Key&) = default;
  Key& operator=(const Key&) = default;

  // `count` secret bytes for one use; a pure function of key and use.
  [[nodiscard]] std::vector<std::uint8_t> stream(KeyUse use, std::size_t count) const;

  // Keyed 32-bit tag of a message (BLAKE2b): a forged or garbled one passes with chance 2^-32.
  [[nodiscard]] std::uint32_t tag(std::span<const std::uint8_t> message) const;

  // 16 hexadecimal digits that tell keys apart in records and reveal nothing usable.
  [[nodiscard]] std::string fingerprint() const;

  [[nodiscard]] bool is_trial() const;

 private:
  Key() = default;
  [[nodiscard]] std::array<std::uint8_t, kBytes> derive(KeyUse use) const;
  std::array<std::uint8_t, kBytes> secret_{};
};

// Lower-case hexadecimal digits, two a byte; and back (throws Error Usage on anything else).
[[nodiscard]] std::string to_hex(std::span<const std::uint8_t> bytes);
[[nodiscard]] std::vector<std::uint8_t> from_hex(const std::string& text);

// BLAKE2b-256 of a file's bytes, in hexadecimal: what records call a hash.
[[nodiscard]] std::string content_hash(std::span<const char> bytes);

}  // namespace triglyph
