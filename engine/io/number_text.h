// Decimal numbers in text files: parsing, and formatting in the style of the file, so that the
// digits do not reveal which coordinates were moved.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace triglyph {

struct ParsedNumber {
  double value;
  const char* end;  // one past the number; null: no finite decimal number starts at `begin`
};

// Parses the longest decimal number at `begin`: an optional sign, digits with an optional point
// (".5" and "5." are numbers) and an optional exponent. The value is correctly rounded whatever the
// locale. Underflow gives zero; overflow, nan, inf and hexadecimal numbers are refused. Does not
// check that a separator follows.
[[nodiscard]] ParsedNumber parse_number(const char* begin, const char* end) noexcept;

enum class Notation {
  Fixed,       // 0.0000123
  General,     // like %g: an exponent only of small and of large numbers
  Scientific,  // every number has an exponent
};

// The style in which the numbers of one text file are written.
struct NumberStyle {
  int decimals = 0;                 // most digits after the point
  int significant = 1;              // most significant digits; at most 17
  bool is_fixed = false;            // every number has exactly `decimals` digits after the point
  bool trims_zeros = true;          // 1.5, not 1.500000
  bool keeps_point_zero = false;    // 1.0, where trims_zeros would say 1
  bool drops_leading_zero = false;  // .5, not 0.5
  Notation notation = Notation::Fixed;
  int exponent_digits = 2;          // fewest digits of an exponent
  bool has_upper_exponent = false;  // 1E-5
  bool has_plus_exponent = true;    // 1e+6, not 1e6
  bool has_plus_sign = false;       // +1.5
  // In General notation, numbers of a power of ten below the least or from the most on have an
  // exponent: %g from -4 to its digits, Java -3 to 7, JavaScript -6 to 21.
  int least_plain_power = -4;
  int most_plain_power = 400;

  bool operator==(const NumberStyle&) const = default;
};

// Returns the style that the tokens share; integers if there are none. Precondition: parse_number
// accepts each token as a whole. O(characters).
[[nodiscard]] NumberStyle learn_style(std::span<const std::string_view> tokens);

// Returns the number of decimals with which `value` is written: as many as the style's most
// decimals and its most significant digits both allow.
[[nodiscard]] int decimals_at(const NumberStyle& style, double value);

// Returns the distance between neighbouring numbers of the style at the magnitude of `value`.
[[nodiscard]] double step_at(const NumberStyle& style, double value);

// Returns the value that format_number(style, value) reads back as; never -0.
[[nodiscard]] double round_to(const NumberStyle& style, double value);

// Room for the longest double in fixed notation: a sign, 309 digits, a point and the decimals.
inline constexpr std::size_t kNumberCapacity = 768;

// Writes the number to `out` and returns the end of the text; never writes a negative zero.
// Preconditions: `out` has room for kNumberCapacity characters, and `value` is finite.
char* format_number(const NumberStyle& style, double value, char* out);

// Returns the token at `begin` for an error message: up to the next blank, at most 24 characters,
// printable.
[[nodiscard]] std::string show_token(const char* begin, const char* end);

}  // namespace triglyph
