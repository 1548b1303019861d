// The one exception of the engine: bad input or a bad environment, said in one line that names
// the file, the place in it and the value seen. A broken promise inside the program is check().
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

namespace triglyph {

enum class ErrorCode {
  Unreadable,   // the file is not there, is no regular file, or may not be read
  Malformed,    // the file breaks the rules of its format
  Unsupported,  // a format or a variant that is not handled
  Unwritable,   // the output cannot be created, filled or renamed
  Usage,        // options that contradict each other or the input
};

// Stable, lower-case name for records ("malformed").
[[nodiscard]] std::string_view name_of(ErrorCode code);

class Error : public std::runtime_error {
 public:
  // `place` is "line 12" or "byte 84"; empty where the whole file is meant. The text of what() is
  // "path: place: message", without the parts that are empty.
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

// "line 12" and "byte 84", the two places an Error names.
[[nodiscard]] std::string at_line(std::size_t line);
[[nodiscard]] std::string at_byte(std::size_t offset);

// Returns what the system says of an errno. Unlike strerror() it may be called from any thread.
[[nodiscard]] std::string system_reason(int number);

// Ends in std::logic_error naming the caller's file and line if the promise is broken; always on.
void check(bool promise, const char* text, const char* file = __builtin_FILE(),
           int line = __builtin_LINE());

}  // namespace triglyph
