#include "engine/io/number_text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <system_error>

namespace triglyph {
namespace {

constexpr int kMaxSignificant = 17;  // a double holds no more
constexpr int kMaxExactPower = 22;   // 10^22 is the last power of ten a double holds
// Tokens of equal length from which on zeros count as not trimmed: if they were, one number in ten
// would be shorter, and 40 numbers would miss that with a probability of 1 in 70.
constexpr std::size_t kMinFixedTokens = 40;
constexpr double kMaxExactInteger = 0x1.0p53;  // below it every integer is a double

constexpr std::array<double, 23> kPower = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                           1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                           1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

constexpr bool is_digit(char c) noexcept {
  return c >= '0' && c <= '9';
}

// The slow path for many digits or a large exponent. `magnitude` is the power of ten of the first
// digit, which distinguishes underflow from overflow.
ParsedNumber parse_slowly(const char* begin, const char* end, std::int64_t magnitude) noexcept {
  const bool negative = *begin == '-';
  if (*begin == '+') ++begin;  // std::from_chars takes none
  double value = 0;
  const std::from_chars_result result = std::from_chars(begin, end, value);
  if (result.ec == std::errc{} && std::isfinite(value)) return {value, end};
  if (result.ec == std::errc::result_out_of_range && magnitude < 0) {
    return {negative ? -0.0 : 0.0, end};
  }
  return {0, nullptr};
}

// Returns the number of digits before the point; zero or negative for numbers below 1 (-1 for
// 0.05). Precondition: v > 0.
int integer_digits(double v) {
  if (v >= 1) {
    int digits = 1;
    while (digits <= kMaxExactPower && v >= kPower[digits]) ++digits;
    if (digits <= kMaxExactPower) return digits;
  } else if (v >= 1e-4) {
    return v >= 1e-1 ? 0 : v >= 1e-2 ? -1 : v >= 1e-3 ? -2 : -3;
  }
  return static_cast<int>(std::floor(std::log10(v))) + 1;
}

// Returns magnitude * 10^decimals, rounded as the exact product would be, if double arithmetic can
// decide that.
std::optional<std::uint64_t> scaled_integer(double magnitude, int decimals) {
  if (decimals > kMaxExactPower) return std::nullopt;
  const double scaled = magnitude * kPower[decimals];
  if (!(scaled < kMaxExactInteger / 2)) return std::nullopt;
  const auto whole = static_cast<std::uint64_t>(scaled);
  const double rest = scaled - static_cast<double>(whole);
  // The product is off by at most half a unit in the last place, so near a tie it decides nothing.
  if (std::abs(rest - 0.5) <= scaled * 0x1.0p-51) return std::nullopt;
  return rest > 0.5 ? whole + 1 : whole;
}

// Removes trailing zeros, and the point if no digit is left behind it.
char* trim_zeros(const NumberStyle& style, char* begin, char* end) {
  if (std::find(begin, end, '.') == end) return end;
  while (end[-1] == '0') --end;
  if (end[-1] != '.') return end;
  if (style.keeps_point_zero) {
    *end = '0';
    return end + 1;
  }
  return end - 1;
}

char* print_fixed(double value, int decimals, char* out) {
  char* p = out;
  if (const auto scaled = scaled_integer(std::abs(value), decimals)) {
    if (value < 0 && *scaled != 0) *p++ = '-';
    char digits[24];
    const char* stop = std::to_chars(digits, digits + sizeof digits, *scaled).ptr;
    const auto count = static_cast<int>(stop - digits);
    const int whole = std::max(count - decimals, 0);
    if (whole == 0) *p++ = '0';
    p = std::copy(digits, digits + whole, p);
    if (decimals > 0) {
      *p++ = '.';
      for (int i = count; i < decimals; ++i) *p++ = '0';
      p = std::copy(digits + whole, digits + count, p);
    }
    return p;
  }
  p = std::to_chars(out, out + kNumberCapacity, value, std::chars_format::fixed, decimals).ptr;
  const bool is_zero =
      std::all_of(out + (*out == '-' ? 1 : 0), p, [](char c) { return c == '0' || c == '.'; });
  if (*out == '-' && is_zero) {
    std::memmove(out, out + 1, static_cast<std::size_t>(p - out - 1));
    --p;
  }
  return p;
}

char* finish_fixed(const NumberStyle& style, char* out, char* end) {
  if (style.trims_zeros) {
    end = trim_zeros(style, out, end);
  }
  if (!style.drops_leading_zero) return end;
  char* first = out + (*out == '-' ? 1 : 0);
  if (end - first < 3 || first[0] != '0' || first[1] != '.') return end;
  std::memmove(first, first + 1, static_cast<std::size_t>(end - first - 1));
  return end - 1;
}

char* print_scientific(const NumberStyle& style, double value, int precision, char* out) {
  if (value == 0) value = 0;  // -0 -> 0
  char text[kNumberCapacity];
  char* end =
      std::to_chars(text, text + sizeof text, value, std::chars_format::scientific, precision).ptr;
  char* exponent = std::find(text, end, 'e');
  char* p = std::copy(text, exponent, out);
  if (style.trims_zeros) p = trim_zeros(style, out, p);
  *p++ = style.has_upper_exponent ? 'E' : 'e';
  if (exponent[1] == '-' || style.has_plus_exponent) *p++ = exponent[1];
  const char* digits = exponent + 2;  // at least two of them
  while (end - digits > style.exponent_digits && *digits == '0') ++digits;
  for (auto have = end - digits; have < style.exponent_digits; ++have) *p++ = '0';
  return std::copy(digits, static_cast<const char*>(end), p);
}

// Puts a plus before a number without a sign, where the style has one.
char* with_sign(const NumberStyle& style, char* begin, char* end) {
  if (!style.has_plus_sign || *begin == '-') return end;
  std::memmove(begin + 1, begin, static_cast<std::size_t>(end - begin));
  *begin = '+';
  return end + 1;
}

// The properties of one token.
struct TokenShape {
  int decimals = 0;
  int significant = 0;
  int exponent_digits = 0;  // 0: none
  bool has_point = false;
  bool is_zero = true;
  bool has_trailing_zero = false;  // after the point, other than a lone ".0"
  bool has_point_zero = false;     // "1.0"
  bool starts_with_point = false;
  bool has_zero_before_point = false;
  bool has_upper_exponent = false;
  bool has_plus_exponent = false;
  bool has_minus_exponent = false;
  int power = 0;  // of ten, of the first digit
};

TokenShape shape_of(std::string_view token) {
  TokenShape shape;
  if (!token.empty() && (token[0] == '-' || token[0] == '+')) token.remove_prefix(1);
  const std::size_t mark = token.find_first_of("eE");
  const std::string_view mantissa = token.substr(0, mark);
  const std::size_t point = mantissa.find('.');
  shape.has_point = point != std::string_view::npos;
  const std::string_view fraction = shape.has_point ? mantissa.substr(point + 1) : "";
  shape.starts_with_point = point == 0;
  shape.has_zero_before_point = point == 1 && mantissa[0] == '0';
  shape.has_point_zero = fraction == "0";
  shape.has_trailing_zero = fraction.size() > 1 && fraction.back() == '0';
  for (const char c : mantissa) {
    if (c == '.') continue;
    if (c != '0') shape.is_zero = false;
    if (!shape.is_zero) ++shape.significant;
  }
  int exponent = 0;
  if (mark != std::string_view::npos) {
    std::string_view power = token.substr(mark + 1);
    shape.has_upper_exponent = token[mark] == 'E';
    shape.has_plus_exponent = power[0] == '+';
    shape.has_minus_exponent = power[0] == '-';
    if (power[0] == '+') power.remove_prefix(1);
    std::from_chars(power.data(), power.data() + power.size(), exponent);
    if (power[0] == '-') power.remove_prefix(1);
    shape.exponent_digits = static_cast<int>(std::min<std::size_t>(power.size(), 4));
  }
  const auto fraction_size = static_cast<std::int64_t>(fraction.size());
  if (shape.is_zero) exponent = 0;
  const std::size_t first = mantissa.find_first_of("123456789");
  if (first != std::string_view::npos) {
    const auto whole = static_cast<std::int64_t>(std::min(point, mantissa.size()));
    const auto at = static_cast<std::int64_t>(first);
    const std::int64_t power = exponent + (at < whole ? whole - at - 1 : whole - at);
    shape.power = static_cast<int>(std::clamp<std::int64_t>(power, -400, 400));
  }
  shape.decimals = static_cast<int>(std::clamp<std::int64_t>(fraction_size - exponent, 0, 340));
  return shape;
}

// The powers of ten that numbers of one kind have.
struct PowerRange {
  int least = 1000, most = -1000;
  void add(int power) {
    least = std::min(least, power);
    most = std::max(most, power);
  }
  [[nodiscard]] bool has() const { return most >= least; }
};

// Chooses the powers of ten that have no exponent in General notation as a known writer does it,
// or, where none fits, as the numbers themselves say.
void choose_plain_powers(NumberStyle& style, const PowerRange& plain, const PowerRange& small,
                         const PowerRange& large) {
  const auto fits = [&](int least, int most) {
    return (!plain.has() || (plain.least >= least && plain.most < most)) &&
           (!small.has() || small.most < least) && (!large.has() || large.least >= most);
  };
  struct Writer {
    int least, most;
    bool pads, is_upper;
  };
  const Writer writers[] = {
      {-4, style.significant, true, false},  // %g
      {-4, style.significant, true, true},   // %G
      {-4, 16, true, false},                 // Python
      {-5, 15, true, true},                  // C#
      {-3, 7, false, true},                  // Java
      {-6, 21, false, false},                // JavaScript
      {-4, style.significant, false, false},
      {-4, 16, false, false},
      {-5, 16, false, false},  // Rust, {:?}
  };
  const bool pads = style.exponent_digits > 1;
  for (const bool strictly : {true, false}) {
    for (const Writer& writer : writers) {
      const bool is_alike = writer.pads == pads && writer.is_upper == style.has_upper_exponent;
      if ((strictly && !is_alike) || !fits(writer.least, writer.most)) continue;
      style.least_plain_power = writer.least;
      style.most_plain_power = writer.most;
      return;
    }
  }
  if (small.has()) style.least_plain_power = small.most + 1;
  style.most_plain_power = large.has() ? large.least : 400;
}

// Returns whether the style gives the number an exponent.
bool has_exponent(const NumberStyle& style, double value) {
  if (style.notation != Notation::General) return style.notation == Notation::Scientific;
  if (value == 0) return false;
  const double magnitude = std::min(std::abs(value), std::numeric_limits<double>::max());
  const int power = integer_digits(magnitude) - 1;
  return power < style.least_plain_power || power >= style.most_plain_power;
}

}  // namespace

ParsedNumber parse_number(const char* begin, const char* end) noexcept {
  const char* p = begin;
  bool negative = false;
  if (p != end && (*p == '-' || *p == '+')) negative = *p++ == '-';
  const char* digits = p;
  std::uint64_t mantissa = 0;
  while (p != end && is_digit(*p)) mantissa = mantissa * 10 + static_cast<unsigned>(*p++ - '0');
  std::int64_t count = p - digits;
  const char* point = p;
  std::int64_t exponent = 0, written_power = 0;
  if (p != end && *p == '.') {
    const char* fraction = ++p;
    while (p != end && is_digit(*p)) mantissa = mantissa * 10 + static_cast<unsigned>(*p++ - '0');
    exponent = fraction - p;
    count -= exponent;
  }
  if (count == 0) return {0, nullptr};
  if (p != end && (*p == 'e' || *p == 'E')) {
    const char* q = p + 1;
    bool shrinks = false;
    if (q != end && (*q == '-' || *q == '+')) shrinks = *q++ == '-';
    if (q == end || !is_digit(*q)) return {0, nullptr};
    std::int64_t power = 0;
    // Beyond a million only the sign matters, unless the token has a million zeros.
    for (; q != end && is_digit(*q); ++q)
      power = std::min<std::int64_t>(power * 10 + (*q - '0'), 1000000);
    written_power = shrinks ? -power : power;
    exponent += written_power;
    p = q;
  }
  // Clinger's fast path: both factors are exact, so one operation rounds once.
  if (count <= 19 && mantissa <= (std::uint64_t{1} << 53) && exponent >= -kMaxExactPower &&
      exponent <= kMaxExactPower) {
    const auto exact = static_cast<double>(mantissa);
    const double value = exponent < 0 ? exact / kPower[-exponent] : exact * kPower[exponent];
    return {negative ? -value : value, p};
  }
  const char* first = digits;
  while (first != p && (*first == '0' || *first == '.')) ++first;
  if (first == p || !is_digit(*first)) return {negative ? -0.0 : 0.0, p};
  const std::int64_t before_first = point > first ? point - first - 1 : point - first;
  return parse_slowly(begin, p, written_power + before_first);
}

NumberStyle learn_style(std::span<const std::string_view> tokens) {
  NumberStyle style;
  style.significant = 0;
  std::size_t exponents = 0, numbers = 0, bare_points = 0, zero_points = 0;
  std::size_t pluses = 0, minuses = 0, plain_powers = 0;
  bool has_trailing_zero = false, same_decimals = true;
  int first_decimals = -1;
  PowerRange plain, small, large;
  for (const std::string_view token : tokens) {
    const TokenShape shape = shape_of(token);
    pluses += !token.empty() && token[0] == '+';
    minuses += !token.empty() && token[0] == '-';
    if (!shape.is_zero)
      (shape.exponent_digits == 0 ? plain : shape.power < 0 ? small : large).add(shape.power);
    plain_powers +=
        shape.exponent_digits > 0 && !shape.has_plus_exponent && !shape.has_minus_exponent;
    style.decimals = std::max(style.decimals, shape.decimals);
    style.significant = std::max(style.significant, shape.significant);
    style.keeps_point_zero |= shape.has_point_zero;
    style.has_upper_exponent |= shape.has_upper_exponent;
    has_trailing_zero |= shape.has_trailing_zero;
    bare_points += shape.starts_with_point;
    zero_points += shape.has_zero_before_point;
    if (!shape.is_zero) ++numbers;
    if (shape.exponent_digits > 0) {
      style.exponent_digits = exponents == 0
                                  ? shape.exponent_digits
                                  : std::min(style.exponent_digits, shape.exponent_digits);
      exponents += !shape.is_zero;
    }
    if (first_decimals < 0) first_decimals = shape.decimals;
    same_decimals &= shape.decimals == first_decimals;
  }
  style.significant = std::clamp(style.significant, 1, kMaxSignificant);
  style.is_fixed = exponents == 0 && same_decimals && style.decimals > 0 &&
                   (has_trailing_zero || tokens.size() > kMinFixedTokens);
  style.trims_zeros = !has_trailing_zero && !style.is_fixed;
  style.drops_leading_zero = bare_points > zero_points;
  // Where no large number tells, those who pad exponents write the plus.
  style.has_plus_exponent = plain_powers == 0 && (style.exponent_digits > 1 || large.has());
  style.has_plus_sign = pluses > 0 && pluses + minuses == tokens.size();
  if (exponents > 0) {
    style.notation = exponents == numbers ? Notation::Scientific : Notation::General;
    choose_plain_powers(style, plain, small, large);
  }
  return style;
}

int decimals_at(const NumberStyle& style, double value) {
  if (value == 0 || !std::isfinite(value)) {
    return style.is_fixed ? style.decimals : std::min(style.decimals, style.significant);
  }
  const int digits = integer_digits(std::abs(value));
  int decimals =
      style.is_fixed ? style.decimals : std::min(style.decimals, style.significant - digits);
  if (style.notation == Notation::Scientific) decimals = style.significant - digits;
  return std::max(std::min(decimals, kMaxSignificant - digits), 0);
}

double step_at(const NumberStyle& style, double value) {
  const double magnitude = std::abs(value);
  double step = 0;
  const bool counts_digits =
      style.notation == Notation::Scientific || (magnitude >= 1 && has_exponent(style, magnitude));
  if (value != 0 && counts_digits) {
    step = std::pow(10.0, integer_digits(magnitude) - style.significant);
  } else {
    const int decimals = decimals_at(style, value);
    step = decimals <= kMaxExactPower ? 1 / kPower[decimals] : std::pow(10.0, -decimals);
  }
  // With many digits, several decimal numbers give the same double.
  return std::max(step, magnitude - std::nextafter(magnitude, -1.0));
}

double round_to(const NumberStyle& style, double value) {
  // A little above the number too, since rounding may carry it to the first with an exponent.
  constexpr double kAbove = 1.1;
  const bool is_plain = style.notation == Notation::Fixed || (style.notation == Notation::General &&
                                                              !has_exponent(style, value * kAbove));
  if (is_plain) {
    const int decimals = decimals_at(style, value);
    if (const auto scaled = scaled_integer(std::abs(value), decimals)) {
      const double rounded = static_cast<double>(*scaled) / kPower[decimals];
      return value < 0 && *scaled != 0 ? -rounded : rounded;
    }
  }
  char text[kNumberCapacity];
  const char* end = format_number(style, value, text);
  const double rounded = parse_number(text, end).value;
  return rounded == 0 ? 0.0 : rounded;
}

char* format_number(const NumberStyle& style, double value, char* out) {
  if (style.notation == Notation::Scientific) {
    char* end = print_scientific(style, value, style.significant - 1, out);
    if (parse_number(out, end).end == nullptr) {  // rounded up past the largest
      end = print_scientific(style, value, kMaxSignificant - 1, out);
    }
    return with_sign(style, out, end);
  }
  const int decimals = decimals_at(style, value);
  if (style.notation == Notation::General && value != 0) {
    // What the number is rounded to decides how it is written.
    char text[kNumberCapacity];
    const int digits = integer_digits(std::abs(value));
    if (digits >= style.most_plain_power) {
      char* end = print_scientific(style, value, style.significant - 1, out);
      const double rounded = parse_number(out, end).value;
      if (has_exponent(style, rounded)) return with_sign(style, out, end);
    } else {
      const char* end = print_fixed(value, decimals, text);
      const double rounded = parse_number(text, end).value;
      const int left = rounded == 0 ? 1 : integer_digits(std::abs(rounded));
      if (left - 1 < style.least_plain_power) {
        return with_sign(style, out,
                         print_scientific(style, rounded, std::max(decimals + left - 1, 0), out));
      }
    }
  }
  return with_sign(style, out, finish_fixed(style, out, print_fixed(value, decimals, out)));
}

std::string show_token(const char* begin, const char* end) {
  constexpr std::size_t kShown = 24;
  if (begin == end) return "the end of the file";
  std::string text = "'";
  for (const char* p = begin; p != end && *p != ' ' && (*p < '\t' || *p > '\r'); ++p) {
    if (text.size() > kShown) return text + "...'";
    text += *p > ' ' && *p < 0x7f ? *p : '?';
  }
  return text.size() == 1 ? "the end of the line" : text + "'";
}

}  // namespace triglyph
