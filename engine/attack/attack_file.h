// An attack on a mesh file, and a collusion of several.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

#include "engine/attack/attack.h"
#include "engine/attack/collusion.h"

namespace triglyph {

struct AttackedFile {
  std::size_t points = 0;
  std::size_t triangles = 0;
};

// Reads a mesh, attacks it and writes the result, whole or not at all. The output has the format of
// the input, text or binary, if their names end alike, else that of its own ending; polygons come
// out as triangles, and what is no coordinate or corner is lost. Text holds nine digits, with which
// any float reads back exactly, binary files floats. Throws Error as MeshFile::open(), OutputFile
// and Attack::applied() do, Unsupported for an output whose ending is no mesh's, and Usage for one
// that is the input.
AttackedFile attack_file(const std::filesystem::path& mesh, const std::filesystem::path& out,
                         const Attack& attack, std::uint64_t seed);

// Reads copies of a mesh, combines them, attacks the result and writes it, as attack_file() would
// that of the first copy. Throws Error as attack_file(), read_copies() and colluded() do, and Usage
// for an output that is any of the copies.
AttackedFile collude_files(std::span<const std::filesystem::path> copies,
                           const std::filesystem::path& out, Collusion collusion,
                           const Attack& attack, std::uint64_t seed);

}  // namespace triglyph
