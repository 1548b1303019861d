// Text of unknown origin: what can be shown of it, what was meant by it, and the endings of file
// names.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
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

// Returns the word of a list that a mistyped one is closest to, or nothing if more than a third of
// its letters would have to change: inserted, deleted, replaced or swapped with a neighbour
// (Damerau-Levenshtein, each place edited once). Ties go to the first. O(letters^2 * words).
[[nodiscard]] std::optional<std::string> closest_word(std::string_view word,
                                                      std::span<const std::string> known);

}  // namespace triglyph
