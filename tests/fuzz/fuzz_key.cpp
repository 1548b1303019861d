// Key files. One that is a key is saved and loaded as the same.
#include <filesystem>

#include "engine/base/error.h"
#include "engine/message/key.h"
#include "tests/fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  namespace fs = std::filesystem;
  const auto path = triglyph::fuzz::folder().write("key", triglyph::fuzz::text_of(data, size));
  fs::permissions(path, fs::perms::owner_read | fs::perms::owner_write);
  try {
    const triglyph::Key key = triglyph::Key::load(path);
    const auto copy = triglyph::fuzz::folder() / "copy";
    fs::remove(copy);
    key.save(copy);
    triglyph::fuzz::expect(triglyph::Key::load(copy).fingerprint() == key.fingerprint());
  } catch (const triglyph::Error&) {
    return 0;
  }
  return 0;
}
