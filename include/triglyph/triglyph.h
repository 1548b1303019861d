// Hides a blind, invisible watermark in mesh files (OBJ, OFF, PLY, STL, GLB, glTF) and reads it
// back. This is what programs outside of triglyph include; it names standard types alone.
//
// Every function may be called from several threads at once. Each uses the threads of the arena of
// oneTBB that it is called from, and its result does not depend on how many these are.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <triglyph/api.h>
#include <triglyph/error.h>

namespace triglyph {

// Returns the version of the library, "0.1.0".
[[nodiscard]] TRIGLYPH_API std::string_view version();

// The secret behind a mark: without it nobody can find, read or forge one. Copies share the secret,
// which is wiped from memory with the last of them.
class TRIGLYPH_API SecretKey {
 public:
  // Returns the public key that stands in where there is none: anyone can read and forge its marks.
  [[nodiscard]] static SecretKey trial();
  // Returns a new key from the system's random source.
  [[nodiscard]] static SecretKey generate();
  // Reads a key file. Throws Error Unreadable (absent, no regular file, or readable by others) or
  // Malformed.
  [[nodiscard]] static SecretKey load(const std::filesystem::path& path);

  // Creates a key file that its owner alone can read. Throws Error Unwritable, also if the file
  // exists: a key is never overwritten.
  void save(const std::filesystem::path& path) const;

  // Returns 16 hexadecimal digits that tell keys apart and reveal nothing usable.
  [[nodiscard]] std::string fingerprint() const;

  struct Secret;
  [[nodiscard]] const Secret& secret() const { return *secret_; }  // for the library itself

 private:
  explicit SecretKey(std::shared_ptr<const Secret> secret);
  std::shared_ptr<const Secret> secret_;
};

// Options of marking by the keys of manifests, with values as on the command line:
// {{"message", "for Ada"}, {"scheme", "aie"}, {"max_move", "0.05"}}.
using Settings = std::map<std::string, std::string, std::less<>>;

// An option that Settings may hold.
struct SettingInfo {
  std::string key;           // "max_move"
  std::string domain;        // its range or choices in words
  std::string default_text;  // what applies where it is not set; may be empty
  std::string help;          // one line
};

// Returns every option, in the order in which `triglyph mark --help` lists them.
[[nodiscard]] TRIGLYPH_API std::vector<SettingInfo> mark_settings();

// What came of marking one file.
struct MarkReport {
  bool marked = false;  // the output is there, and the message was read back from it
  std::string status;   // "marked", "too small", "malformed", ...: see docs/records.md
  std::string error;    // one line that names file and place; empty if marked
  std::uint64_t vertices = 0;
  std::uint64_t faces = 0;
  std::uint32_t units = 0;        // that carry a part of the message
  double hausdorff = 0;           // between input and output, model units, certified
  double hausdorff_rel_diag = 0;  // the same as a share of the bounding box's diagonal
  std::string record;             // the line of JSON that verify_file() and `triglyph verify` read
};

// Hides a message in the mesh file `mesh` and writes the result to `out`, in the input's format;
// the output appears only once its message was read back from it. `settings` must hold "message",
// "message_hex" or "fill". What is wrong with the mesh or the output is the report's status. Throws
// Error Usage for settings that make no sense. O(n log n) in the mesh's size.
[[nodiscard]] TRIGLYPH_API MarkReport mark_file(const std::filesystem::path& mesh,
                                                const std::filesystem::path& out,
                                                const Settings& settings, const SecretKey& key);

// What a file of unknown origin says.
struct ReadReport {
  std::optional<std::string> message;  // its bytes; nothing: no mark under these keys, or a number
  std::string number;   // hexadecimal: the flux layer holds the number of a message, not itself
  std::string scheme;   // that answered: "tsq", "aie", "iie" or "flux"
  std::size_t key = 0;  // index of the key that answered
  std::uint32_t units_agreeing = 0;  // that say exactly this message
  double false_alarm = 0;  // chance at most that an unmarked mesh yields any message this way
};

// Looks for a mark made with any of the keys. Tries every scheme and every generation of defaults,
// unless `settings` name a scheme or a word format. Throws Error if the file cannot be read, and
// Usage for settings that make no sense or no keys. O(n log n) for each key and scheme.
[[nodiscard]] TRIGLYPH_API ReadReport read_file(const std::filesystem::path& path,
                                                std::span<const SecretKey> keys,
                                                const Settings& settings = {});

// What became of a marked file.
struct VerifyReport {
  // "intact", "altered, mark present", "mark lost", "damaged", "missing" or "not marked".
  std::string verdict;
  std::string detail;  // why, in one line; empty if intact
  std::uint32_t units_found = 0;
  // Vertices of the file, from 0, that damaged units depend on, ascending. Known if the record
  // holds its units (setting "detail") and the file still numbers its vertices as it was written.
  std::vector<std::uint64_t> damaged_vertices;
};

// Compares the file that a record names with what the record says was written there. `record` is
// MarkReport::record or a line of `triglyph mark --json`. Under another key than the mark's the
// verdict is "mark lost", and the detail says so. Throws Error Malformed if it is no record.
// O(n log n).
[[nodiscard]] TRIGLYPH_API VerifyReport verify_file(std::string_view record, const SecretKey& key);

}  // namespace triglyph
