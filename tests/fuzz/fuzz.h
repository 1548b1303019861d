// What the fuzz targets share. Each is a program of its own, which libFuzzer calls with one input
// after the other. Bad input must end in an Error, whatever it is; anything else ends the program,
// and the input is kept.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include <stdlib.h>
#include <unistd.h>

#include "tests/support/temp_folder.h"

namespace triglyph::fuzz {

// Ends the program, which is the finding, unless the promise holds.
inline void expect(bool promise) {
  if (!promise) std::abort();
}

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

// A folder for inputs that are read as files; below TMPDIR, which should be in memory.
inline const test::TempFolder& folder() {
  static const test::TempFolder folder;
  return folder;
}

}  // namespace triglyph::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
