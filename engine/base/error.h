// The engine's only exception, for bad input or a bad environment: one line that names the file,
// the place in it and the value seen. A broken invariant of the program itself is check().
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

namespace triglyph {

enum class ErrorCode {
  Unreadable,   // the file does not exist, is no regular file, or may not be read
  Malformed,    // the file breaks the rules of its format
  Unsupported,  // a format or a variant that is not handled
  Unwritable,   // the output cannot be created, filled or renamed
  Usage,        // options that contradict each other or the input
};

// Returns the stable, lower-case name that records use ("malformed").
[[nodiscard]] std::string_view name_of(ErrorCode code);

class Error : public std::runtime_error {
 public:
  // `place` is "line 12" or "byte 84", or empty for the whole file. what() returns
  // "path: place: message" without the parts that are empty.
  Error(ErrorCode code, const std::filesystem::path& path, std::string place, std::string message);

  [[nodiscard]] ErrorCode code() const noexcept { return code_; }
  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }
  [[nodiscard]] const std::string& place() const noexcept { return place_; }
  [[nodiscard]] const std::string& message() const noexcept { return message_; }

 private:
  ErrorCode code_;
  std::filesystem::path path_;
  std::string place_;
  std::string message_;
};

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
