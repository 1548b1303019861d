// Extraction from a mesh file of which nothing is known: tries every encoding under every key.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/flux/flux_reading.h"
#include "engine/marking/options.h"
#include "engine/message/key.h"

namespace triglyph {

// A message, and how it was found.
struct FoundMark {
  Message message;  // empty: the flux layer holds a number, which stands for a message
  Encoding encoding;
  std::size_t key = 0;            // index of its key
  std::uint32_t parts = 0;        // of the message
  std::uint32_t agreeing = 0;     // units whose word is exactly that of the message
  double agreement = 0;           // least agreement of the votes over all parts, 0 to 1
  std::optional<FluxFound> flux;  // the flux layer, if it answered
};

struct FileReading {
  std::optional<FoundMark> mark;  // nothing: no mark under these encodings and keys
  std::uint64_t vertices = 0;
  std::uint64_t faces = 0;
  std::uint32_t units_with_marker = 0;  // in the attempt that found the mark, else the most of any
  // Upper bound of the probability that an unmarked mesh yields a message in any of the attempts
  // made, the sum over them: 2^-32 for an attempt with tsq, aie or flux, 2^-22 with iie, which
  // tries 2^10 messages. Where no mark is found every encoding of units is tried turned over, too:
  // once more with tsq and aie, three times with iie. What the flux layer found counts with what it
  // proves.
  double false_alarm = 0;
};

// Tries the encodings in order, each under every key, and stops at the first message. Throws Error
// as MeshFile::open() does, and Usage for an invalid encoding. O(bytes) plus the scheme's reading
// for each attempt.
[[nodiscard]] FileReading read_file(const std::filesystem::path& path,
                                    std::span<const Encoding> encodings, std::span<const Key> keys);

}  // namespace triglyph
