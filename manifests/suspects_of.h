// Who may have a copy: the names of a list or of a ledger.
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "engine/marking/options.h"
#include "engine/marking/trace_file.h"
#include "manifests/ledger.h"
#include "manifests/recipients.h"

namespace triglyph {

// Names, and the messages that other marks of the same owner carry.
struct KnownCopies {
  std::vector<Suspects> suspects;   // for each key
  std::vector<Encoding> encodings;  // of marks that carry a message itself; none: there are none
};

// Returns all whom the ledger knows under each key and, under every key, the names of the list,
// which were marked with any of these options. Either may be missing. `originals` are meshes of
// which the suspects may be copies, besides those whose marks cannot be read without, which the
// ledger names. Throws Error Malformed for options in the ledger that are none, and as
// MeshFile::open() does for an original that is named. The ledger must outlive the result.
// O(marks).
[[nodiscard]] KnownCopies known_copies(const Ledger* ledger, const Recipients* list,
                                       std::span<const MarkOptions> options,
                                       std::span<const Key> keys,
                                       std::span<const std::filesystem::path> originals);

}  // namespace triglyph
