#include "engine/base/error.h"

#include <system_error>
#include <utility>

#include "engine/base/text.h"

namespace triglyph {
namespace {

std::string compose(const std::filesystem::path& path, const std::string& place,
                    const std::string& message) {
  std::string text;
  if (!path.empty()) text += path.string() + ": ";
  if (!place.empty()) text += place + ": ";
  return printable(text + message);  // a key or a name in it may hold line breaks
}

}  // namespace

std::string_view name_of(ErrorCode code) {
  switch (code) {
    case ErrorCode::Unreadable:
      return "unreadable";
    case ErrorCode::Malformed:
      return "malformed";
    case ErrorCode::Unsupported:
      return "unsupported";
    case ErrorCode::Unwritable:
      return "unwritable";
    case ErrorCode::Usage:
      return "usage";
  }
  return "error";
}

Error::Error(ErrorCode code, const std::filesystem::path& path, std::string place,
             std::string message)
    : std::runtime_error(compose(path, place, message)),
      code_(code),
      path_(path),
      place_(std::move(place)),
      message_(std::move(message)) {}

std::string at_line(std::size_t line) {
  return "line " + std::to_string(line);
}

std::string at_byte(std::size_t offset) {
  return "byte " + std::to_string(offset);
}

void check(bool promise, const char* text, const char* file, int line) {
  if (promise) return;
  throw std::logic_error(std::string(file) + ":" + std::to_string(line) + ": " + text);
}

std::string system_reason(int number) {
  return std::generic_category().message(number);
}

}  // namespace triglyph
