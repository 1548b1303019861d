// A cursor over the bytes of a text file, with errors that name the line. Internal to the readers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

#include "engine/io/number_text.h"
#include "engine/io/readers.h"

namespace triglyph {

inline constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

class TextScan {
 public:
  // Starts behind a UTF-8 byte order mark, if there is one. Lines end at a line feed, a carriage
  // return, or both in this order, as some files mix them. Throws Error Unsupported for UTF-16.
  explicit TextScan(const Source& source);

  [[nodiscard]] bool at_end() const noexcept { return p_ == end_; }
  [[nodiscard]] bool at_line_end() const noexcept { return p_ == end_ || is_line_end(*p_); }
  [[nodiscard]] char here() const noexcept { return *p_; }  // precondition: !at_end()
  [[nodiscard]] const char* position() const noexcept { return p_; }
  [[nodiscard]] const char* end() const noexcept { return end_; }
  void move_to(const char* position) noexcept { p_ = position; }

  [[nodiscard]] static bool is_line_end(char c) noexcept { return c == '\n' || c == '\r'; }
  [[nodiscard]] static bool is_blank(char c) noexcept {
    return c == ' ' || c == '\t' || c == '\v' || c == '\f';
  }
  [[nodiscard]] bool is_separator(char c) const noexcept {
    return c == ' ' || (c >= '\t' && c <= '\r') || c == '#' || c == '\\';
  }

  // Skips blanks within the line.
  void skip_blanks() noexcept {
    while (p_ != end_ && is_blank(*p_)) ++p_;
  }
  // Moves behind the next line end.
  void skip_line() noexcept;
  // Returns the position behind the line end that starts there, or null if none does.
  [[nodiscard]] const char* behind_line_end(const char* position) const noexcept;
  // Moves to the next token, across lines; if `comments`, also skips from a '#' to its line end.
  void skip_space(bool comments) noexcept;
  // Returns the bytes up to the next blank, line end or file end, and moves behind them.
  [[nodiscard]] std::string_view take_token() noexcept;

  // Returns the number at the cursor and moves behind it. Throws Error Malformed if there is none,
  // or if no separator follows.
  double take_number() {
    const ParsedNumber number = parse_number(p_, end_);
    if (number.end == nullptr || (number.end != end_ && !is_separator(*number.end))) {
      fail_number();
    }
    p_ = number.end;
    return number.value;
  }
  // Returns the integer at the cursor likewise. Throws Error Malformed, naming `what`, also if it
  // lies outside [low, high].
  std::int64_t take_integer(std::string_view what, std::int64_t low, std::int64_t high);

  [[nodiscard]] std::uint64_t offset(const char* position) const noexcept {
    return static_cast<std::uint64_t>(position - source_.bytes.data());
  }
  [[nodiscard]] std::size_t bytes_left() const noexcept {
    return static_cast<std::size_t>(end_ - p_);
  }

  // Throw Error Malformed with the line of the cursor. fail_at() also quotes the token there.
  [[noreturn]] void fail(const std::string& message) const;
  [[noreturn]] void fail_at(const std::string& message) const;

 private:
  [[noreturn]] void fail_number() const;

  const Source& source_;
  const char* p_;
  const char* end_;
  bool has_carriage_returns_ = false;
};

// Returns the place of a vertex whose coordinates start at x, y and z. Throws Error Unsupported if
// they are more than 2 GiB apart.
[[nodiscard]] TokenPlace place_of(const TextScan& scan, const char* x, const char* y,
                                  const char* z);

}  // namespace triglyph
