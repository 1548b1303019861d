// Is a marked file there, unchanged, and does it carry its message? Where not, which of its units
// are damaged: the mark locates what was done to the mesh.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/marking/mark_file.h"

namespace triglyph {

enum class FileVerdict {
  Intact,     // byte for byte what was written, and it carries its message
  Altered,    // other bytes, but it still carries its message
  Missing,    // no file
  Lost,       // readable, but the message is not there
  Damaged,    // not readable as a mesh
  NotMarked,  // the mesh was not marked
};
[[nodiscard]] std::string_view name_of(FileVerdict verdict);

// Units that no longer read what was written there.
struct Damage {
  std::uint32_t units_expected = 0;
  std::uint32_t units_damaged = 0;
  // Of the file, from 0, on which these depend, ascending; empty unless asked for.
  std::vector<std::uint64_t> vertices;
};

struct Verification {
  FileVerdict verdict = FileVerdict::NotMarked;
  // Units that carry what was written there; where that cannot be told, units that carry any word
  // of the mark.
  std::uint32_t units_found = 0;
  std::string detail;            // why, in one line; empty if intact
  std::optional<Damage> damage;  // if the units are known and the file still numbers them
};

// Looks at the file named by `marked.out`. `locate`: also names the vertices of damaged units. Does
// not throw: what is wrong with the file is the verdict. O(file) and the scheme's reading.
[[nodiscard]] Verification verify_file(const MarkedFile& marked, const Key& key,
                                       bool locate = false);

}  // namespace triglyph
