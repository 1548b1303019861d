// The engine's only exception, for bad input or a bad environment: one line that names the file,
// the place in it and the value seen. A broken invariant of the program itself is check().
#pragma once

#include <cstddef>
#include <string>

#include <triglyph/error.h>

namespace triglyph {

// Return "line 12" and "byte 84", the forms of Error::place().
[[nodiscard]] std::string at_line(std::size_t line);
[[nodiscard]] std::string at_byte(std::size_t offset);

// Returns the system's message for an errno. Thread-safe, unlike strerror().
[[nodiscard]] std::string system_reason(int number);

// Throws std::logic_error naming the caller's file and line unless `promise` holds. Active in every
// build.
void check(bool promise, const char* text, const char* file = __builtin_FILE(),
           int line = __builtin_LINE());

}  // namespace triglyph
