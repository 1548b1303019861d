// A mesh file that is loaded for extraction.
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "engine/io/mesh_file.h"
#include "engine/marking/marking.h"
#include "engine/mesh/surface.h"
#include "engine/message/votes.h"

namespace triglyph {

struct Readable {
  MeshFile file;
  Halfedges halfedges;

  // Throws Error as MeshFile::open does.
  explicit Readable(const std::filesystem::path& path)
      : file(MeshFile::open(path)), halfedges(build_halfedges(file.mesh())) {}
  [[nodiscard]] Surface surface() const { return {file.mesh(), halfedges}; }
};

// Returns the carriers whose word was read at their anchor. Precondition: carriers and readings
// ascend by anchor. O(carriers + readings).
[[nodiscard]] inline std::vector<Carrier> carriers_read(std::span<const Carrier> carriers,
                                                        std::span<const Word> words,
                                                        std::span<const Reading> readings) {
  std::vector<Carrier> found;
  auto reading = readings.begin();
  for (const Carrier& carrier : carriers) {
    while (reading != readings.end() && reading->anchor < carrier.anchor) ++reading;
    if (reading == readings.end()) break;
    if (reading->anchor == carrier.anchor && reading->word == words[carrier.word]) {
      found.push_back(carrier);
    }
  }
  return found;
}

}  // namespace triglyph
