// Reading one mesh file of which nothing is known: every encoding under every key.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/marking/options.h"
#include "engine/message/key.h"

namespace triglyph {

// The message that was found, and how.
struct FoundMark {
  Message message;
  Encoding encoding;
  std::size_t key = 0;         // index of the key that answered
  std::uint32_t parts = 0;     // of the message
  std::uint32_t agreeing = 0;  // units whose word is exactly the message's
  double agreement = 0;        // of the least agreed part's votes, 0 to 1
};

struct FileReading {
  std::optional<FoundMark> mark;  // nothing: no mark under these encodings and keys
  std::uint64_t vertices = 0;
  std::uint64_t faces = 0;
  std::uint32_t units_with_marker = 0;  // in the answering attempt; without a mark the most
  // Chance at most that an unmarked mesh yields a message in one of the attempts made: their
  // chances added up. 2^-32 for an attempt with tsq or aie, 2^-22 with iie, which tries 2^10 ways.
  double false_alarm = 0;
};

// Tries the encodings in their order, each under every key, and stops at the first message. Throws
// Error as MeshFile::open does, and Usage for an encoding that cannot be. O(bytes) and the schemes'
// reading of each attempt.
[[nodiscard]] FileReading read_file(const std::filesystem::path& path,
                                    std::span<const Encoding> encodings, std::span<const Key> keys);

}  // namespace triglyph
