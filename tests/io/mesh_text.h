// Small files for the reader tests.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/base/error.h"
#include "engine/io/mesh_file.h"

namespace triglyph::test {

[[nodiscard]] inline MeshFile read_text(std::string_view text, const std::string& name) {
  return MeshFile::read({text.begin(), text.end()}, name);
}

// "malformed line 3"; "read" if the file is accepted.
[[nodiscard]] inline std::string outcome(std::string_view text, const std::string& name) {
  try {
    (void)read_text(text, name);
    return "read";
  } catch (const Error& error) {
    return std::string(name_of(error.code())) + " " + error.place();
  }
}

// The file with every point moved by `by`, as text.
[[nodiscard]] inline std::string moved(const MeshFile& file, const Vec3& by) {
  std::vector<Vec3> positions = file.mesh().positions;
  for (Vec3& p : positions) p += by;
  const std::vector<char> bytes = file.patched(positions);
  return {bytes.begin(), bytes.end()};
}

}  // namespace triglyph::test
