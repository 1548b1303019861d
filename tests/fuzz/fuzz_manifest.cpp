// Manifests: the input is the file.
#include <fstream>

#include "engine/base/error.h"
#include "manifests/manifest.h"
#include "tests/fuzz/fuzz.h"

namespace {

// A pattern that leaves the folder would search the whole machine.
bool may_leave_the_folder(std::string_view text) {
  for (const std::string_view part : {"..", "\"/", "\\/", "\\u"}) {
    if (text.find(part) != text.npos) return true;
  }
  return false;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = triglyph::fuzz::text_of(data, size);
  if (may_leave_the_folder(text)) return 0;
  static const bool has_meshes = [] {
    triglyph::fuzz::folder().write("a/b.obj", "v 0 0 0\n");
    triglyph::fuzz::folder().write("a/c/d.ply", "ply\n");
    return true;
  }();
  triglyph::fuzz::expect(has_meshes);
  const auto path = triglyph::fuzz::folder().write("manifest.jsonl", text);
  try {
    triglyph::ManifestReader reader(path, {}, triglyph::fuzz::folder() / "out");
    (void)triglyph::check_plan(reader);
  } catch (const triglyph::Error& error) {
    triglyph::fuzz::expect(std::string_view(error.what()).find('\n') == std::string_view::npos);
  }
  return 0;
}
