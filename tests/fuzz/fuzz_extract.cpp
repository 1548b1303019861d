// Extraction. The first byte chooses format and scheme; the rest is the file.
#include <array>

#include "engine/base/error.h"
#include "engine/io/mesh_file.h"
#include "engine/marking/extract.h"
#include "engine/marking/options.h"
#include "engine/mesh/surface.h"
#include "tests/fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::array kNames = {"a.obj", "a.off", "a.ply", "a.stl"};
  static const auto encodings = triglyph::encodings_of({});
  static const triglyph::Key key = triglyph::Key::trial();
  if (size == 0) return 0;
  const std::string_view text = triglyph::fuzz::text_of(data + 1, size - 1);
  const auto& encoding = encodings[data[0] / kNames.size() % encodings.size()];
  try {
    const auto file =
        triglyph::MeshFile::read({text.begin(), text.end()}, kNames[data[0] % kNames.size()]);
    const auto halfedges = triglyph::build_halfedges(file.mesh());
    (void)triglyph::extract({file.mesh(), halfedges}, encoding, key);
  } catch (const triglyph::Error&) {
    return 0;
  }
  return 0;
}
