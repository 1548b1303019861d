// Text of unknown origin: what can be shown of it, and the endings of file names.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace triglyph {

// Returns the text as a terminal may show it: valid UTF-8 without control characters and marks of
// direction is unchanged, any other byte becomes "\x1b". O(bytes).
[[nodiscard]] std::string printable(std::string_view text);

// Returns whether printable() leaves the text as it is, and it is not empty.
[[nodiscard]] bool is_printable(std::string_view text);

// Returns the extension of a file's name in lower case: ".obj" for "A.OBJ".
[[nodiscard]] std::string lower_case_ending(const std::filesystem::path& path);

}  // namespace triglyph
