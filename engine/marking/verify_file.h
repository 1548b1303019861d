// Verification of marked files: whether a file exists, is unchanged and carries its message, and if
// not, which of its units are damaged. The mark thus locates changes of the mesh.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/marking/mark_file.h"

namespace triglyph {

enum class FileVerdict {
  Intact,     // the bytes are those written, and the message can be read
  Altered,    // the bytes differ, but the message can be read
  Missing,    // there is no such file
  Lost,       // the mesh can be read, but not the message
  Damaged,    // the file cannot be read as a mesh
  NotMarked,  // the mesh was not marked
};
[[nodiscard]] std::string_view name_of(FileVerdict verdict);

// Units from which the word that was written can no longer be read.
struct Damage {
  std::uint32_t units_expected = 0;
  std::uint32_t units_damaged = 0;
  // Vertices of the file, from 0, on which these units depend, ascending; only if `locate` is set.
  std::vector<std::uint64_t> vertices;
};

struct Verification {
  FileVerdict verdict = FileVerdict::NotMarked;
  // Units from which the word that was written can be read; if the units are not known, units with
  // any word of the mark.
  std::uint32_t units_found = 0;
  std::string detail;            // the reason in one line; empty if intact
  std::optional<Damage> damage;  // if the units are recorded and still have their numbers
};

// Returns the verdict on the file `marked.out`. `locate` also lists the vertices of damaged units.
// Errors of the file become the verdict and are not thrown. O(file) plus the scheme's reading.
[[nodiscard]] Verification verify_file(const MarkedFile& marked, const Key& key,
                                       bool locate = false);

}  // namespace triglyph
