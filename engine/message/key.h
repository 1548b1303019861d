// The secret key of a mark, and what is derived from it. Without the key nobody can find the units
// (marker, offsets), order the parts (permutation), read them (keystream) or forge a message (tag).
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace triglyph {

// The purpose of a derived stream of secret bytes. The values are fixed for good, since every
// marked file depends on them.
enum class KeyUse : std::uint64_t {
  Fingerprint = 0,
  Marker = 1,
  Offsets = 2,
  Permutation = 3,
  Keystream = 4,
  Tag = 5,
  Fill = 6,
  FluxDither = 7,
  FluxScramble = 8,
  FluxNumber = 9,
  CopySeed = 10,
  CopyBias = 11,
};

class Key {
 public:
  static constexpr std::size_t kBytes = 32;

  // Returns the public key that is used if none is given. Anyone can read and forge marks made with
  // it.
  [[nodiscard]] static Key trial();

  // Returns one of the public keys of trials that need several, the same on every machine. Number 0
  // is trial() itself.
  [[nodiscard]] static Key trial(std::uint64_t number);

  // Returns a new key from the system's random source.
  [[nodiscard]] static Key generate();

  // Reads a file that save() wrote. Throws Error: Unreadable (does not exist, a symbolic link, not
  // a regular file, or readable by group or others) or Malformed (not a key file, wrong check
  // digits).
  [[nodiscard]] static Key load(const std::filesystem::path& path);

  // Creates the file with mode 0600. Throws Error Unwritable, also if the file exists: a key is
  // never overwritten.
  void save(const std::filesystem::path& path) const;

  ~Key();
  Key(const Key&) = default;
  Key& operator=(const Key&) = default;

  // Returns `count` secret bytes, a pure function of key and use. O(count).
  [[nodiscard]] std::vector<std::uint8_t> stream(KeyUse use, std::size_t count) const;

  // Returns the keyed 32-bit tag of a message (BLAKE2b). A forged or garbled message passes with
  // probability 2^-32.
  [[nodiscard]] std::uint32_t tag(std::span<const std::uint8_t> message) const;

  // Returns a keyed 64-bit number of a message (BLAKE2b), by which an owner who keeps the messages
  // recognises it. Independent of the tag.
  [[nodiscard]] std::uint64_t number(std::span<const std::uint8_t> message) const;

  // Returns a keyed 64-bit number of a name (BLAKE2b), from which the bits of its fingerprint
  // follow: see FingerprintCode. Secret, and independent of the others.
  [[nodiscard]] std::uint64_t copy_seed(std::span<const std::uint8_t> name) const;

  // Returns 16 hexadecimal digits that identify the key in records without revealing it.
  [[nodiscard]] std::string fingerprint() const;

  [[nodiscard]] bool is_trial() const;

 private:
  Key() = default;
  [[nodiscard]] std::array<std::uint8_t, kBytes> derive(KeyUse use) const;
  [[nodiscard]] std::uint64_t keyed_number(std::span<const std::uint8_t> bytes, KeyUse use) const;
  std::array<std::uint8_t, kBytes> secret_{};
};

// Convert bytes to lower-case hexadecimal digits, two per byte, and back. from_hex() throws Error
// Usage for other text.
[[nodiscard]] std::string to_hex(std::span<const std::uint8_t> bytes);
[[nodiscard]] std::vector<std::uint8_t> from_hex(const std::string& text);

// Returns a message for the eye: printable text in quotes, anything else as "0x" and hexadecimal.
[[nodiscard]] std::string shown(std::span<const std::uint8_t> message);

// Returns the BLAKE2b-256 hash of a file's bytes in hexadecimal, as records show it. O(bytes).
[[nodiscard]] std::string content_hash(std::span<const char> bytes);

}  // namespace triglyph
