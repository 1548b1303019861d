// Decimal numbers in text files: reading one, and writing one in the manner of the file it goes
// into, so that no reader can tell from its digits which coordinates were moved.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace triglyph {

struct ParsedNumber {
  double value;
  const char* end;  // one past the number; null: no finite decimal number starts here
};

// Reads the longest decimal number at `begin`: an optional sign, digits with an optional point
// (".5" and "5." count), an optional exponent. Correctly rounded whatever the locale; what is too
// small becomes zero, what is too large is refused, as are nan, inf and hexadecimal.
// The caller checks that a separator follows.
[[nodiscard]] ParsedNumber parse_number(const char* begin, const char* end) noexcept;

enum class Notation {
  Fixed,       // 0.0000123
  General,     // like %g: an exponent below 1e-4 alone
  Scientific,  // every number has an exponent
};

// How the numbers of one text file are written.
struct NumberStyle {
  int decimals = 0;                 // most digits after the point
  int significant = 1;              // most digits from the first that is not zero; at most 17
  bool is_fixed = false;            // every number has exactly `decimals` digits after the point
  bool trims_zeros = true;          // 1.5, not 1.500000
  bool keeps_point_zero = false;    // 1.0, where trims_zeros would say 1
  bool drops_leading_zero = false;  // .5, not 0.5
  Notation notation = Notation::Fixed;
  int exponent_digits = 2;          // at least
  bool has_upper_exponent = false;  // 1E-5

  bool operator==(const NumberStyle&) const = default;
};

// The style that the tokens share; each must be a number that parse_number accepts as a whole.
// No token at all gives integers. O(characters).
[[nodiscard]] NumberStyle learn_style(std::span<const std::string_view> tokens);

// A number that moved to `value` gets this many decimals: never more than the file's most, and
// never more significant digits than the file's most.
[[nodiscard]] int decimals_at(const NumberStyle& style, double value);

// The distance between neighbouring numbers of the style at the magnitude of `value`.
[[nodiscard]] double step_at(const NumberStyle& style, double value);

// What parse_number makes of format_number(style, value); never -0.
[[nodiscard]] double round_to(const NumberStyle& style, double value);

inline constexpr std::size_t kNumberCapacity = 768;  // longest fixed double, with room

// Writes the number to `out`, which has room for kNumberCapacity characters; returns its end.
// Precondition: value is finite. Never writes a negative zero.
char* format_number(const NumberStyle& style, double value, char* out);

// For messages: the bytes at `begin` up to the next blank, cut to 24 and made printable.
[[nodiscard]] std::string show_token(const char* begin, const char* end);

}  // namespace triglyph
