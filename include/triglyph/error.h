// The exception that triglyph throws for bad input or a bad environment.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

#include <triglyph/api.h>

namespace triglyph {

enum class ErrorCode {
  Unreadable,   // the file does not exist, is no regular file, or may not be read
  Malformed,    // the file breaks the rules of its format
  Unsupported,  // a format or a variant that is not handled
  Unwritable,   // the output cannot be created, filled or renamed
  Usage,        // options that contradict each other or the input
};

// Returns the stable, lower-case name that records use ("malformed").
[[nodiscard]] TRIGLYPH_API std::string_view name_of(ErrorCode code);

// Says in one line which file, which place in it and which value is wrong.
class TRIGLYPH_API Error : public std::runtime_error {
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

}  // namespace triglyph
