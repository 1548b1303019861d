#include "engine/io/number_text.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "engine/base/random.h"

namespace triglyph {
namespace {

// NaN where the number is refused or does not reach the end of the text.
double parse(std::string_view text) {
  const ParsedNumber number = parse_number(text.data(), text.data() + text.size());
  if (number.end != text.data() + text.size()) return std::nan("");
  return number.value;
}

std::string format(const NumberStyle& style, double value) {
  char text[kNumberCapacity];
  return {text, format_number(style, value, text)};
}

NumberStyle style_of(const std::vector<std::string_view>& tokens) {
  return learn_style(tokens);
}

TEST(ParseNumber, TakesEveryDecimalForm) {
  EXPECT_EQ(parse("1"), 1.0);
  EXPECT_EQ(parse("+3.5"), 3.5);
  EXPECT_EQ(parse("-.5"), -0.5);
  EXPECT_EQ(parse("5."), 5.0);
  EXPECT_EQ(parse("5.e1"), 50.0);
  EXPECT_EQ(parse("1.25E-2"), 0.0125);
  EXPECT_EQ(parse("1e+05"), 100000.0);
  EXPECT_EQ(parse("00012.50"), 12.5);
  EXPECT_TRUE(std::signbit(parse("-0.0")));
}

TEST(ParseNumber, RefusesWhatIsNoFiniteDecimal) {
  for (const char* text : {"", "-", "+", ".", "-.", "nan", "inf", "-inf", "e5", "1e", "1e+", "0x10",
                           "1e999", "-1e999", "1.2.3", "1,5", "--1", "1d5", "3.1+e2"}) {
    EXPECT_TRUE(std::isnan(parse(text))) << text;
  }
}

TEST(ParseNumber, MakesTinyNumbersZero) {
  EXPECT_EQ(parse("1e-400"), 0.0);
  EXPECT_EQ(parse("0.00000000000000000000000001e-390"), 0.0);
  EXPECT_EQ(parse("-123456789012345678901234567890e-500"), 0.0);
  EXPECT_EQ(parse("0e999999999999"), 0.0);
  EXPECT_EQ(parse("4.9406564584124654e-324"), std::numeric_limits<double>::denorm_min());
}

TEST(ParseNumber, AgreesWithTheCLibrary) {
  const char* const formats[] = {"%.17g", "%g", "%.25f", "%.9e", "%.3f", "%.30g"};
  for (std::uint64_t i = 0; i < 60000; ++i) {
    double value = std::bit_cast<double>(random_bits(1, 2, i));
    if (i % 2 == 0) value = (random_unit(1, 3, i) - 0.5) * 1000;
    if (!std::isfinite(value)) continue;
    char text[400];
    std::snprintf(text, sizeof text, formats[i % 6], value);
    EXPECT_EQ(parse(text), std::strtod(text, nullptr)) << text;
  }
}

TEST(LearnStyle, SeesFixedDecimals) {
  const NumberStyle style = style_of({"0.296502", "-0.907931", "100.450150", "0.000000"});
  EXPECT_EQ(style.decimals, 6);
  EXPECT_TRUE(style.is_fixed);
  EXPECT_EQ(format(style, 0.5), "0.500000");
  EXPECT_EQ(format(style, 4321.5), "4321.500000");
  EXPECT_EQ(format(style, -1e-9), "0.000000");
  EXPECT_EQ(step_at(style, 4321.5), 1e-6);
}

TEST(LearnStyle, SeesSignificantDigits) {
  const NumberStyle style = style_of({"0.296502", "-12.345", "100", "0.0123456", "0.5"});
  EXPECT_EQ(style.significant, 6);
  EXPECT_EQ(format(style, 12.34567891), "12.3457");
  EXPECT_EQ(format(style, 0.012345678), "0.0123457");
  EXPECT_EQ(format(style, 123456.7), "123457");
  EXPECT_EQ(format(style, 0.25), "0.25");
  EXPECT_EQ(format(style, -0.000000001), "0");
  EXPECT_EQ(step_at(style, 12.3), 1e-4);
}

TEST(LearnStyle, WritesSmallNumbersLikePercentG) {
  const NumberStyle style = style_of({"0.296502", "1.23456e-05", "100", "3.5"});
  EXPECT_EQ(style.notation, Notation::General);
  EXPECT_EQ(format(style, 2.5e-5), "2.5e-05");
  EXPECT_EQ(format(style, 2.5e-3), "0.0025");
}

TEST(LearnStyle, KeepsExponentsWhereAllNumbersHaveThem) {
  const NumberStyle style = style_of({"1.234567E+001", "-2.500000E-003", "0.000000E+000"});
  EXPECT_EQ(format(style, 31.25), "3.125000E+001");
  EXPECT_EQ(format(style, -0.0), "0.000000E+000");
  EXPECT_EQ(step_at(style, 31.25), 1e-5);
}

// Which numbers have an exponent, and how it is written, tells the writer.
TEST(LearnStyle, WritesExponentsAsTheFileDoes) {
  const NumberStyle percent_g = style_of({"-586931", "38365.1", "1.18669e+06", "0.5"});
  EXPECT_EQ(format(percent_g, 1189934.2), "1.18993e+06");
  EXPECT_EQ(format(percent_g, 999999.7), "1e+06");
  EXPECT_EQ(format(percent_g, 49390.8), "49390.8");
  EXPECT_EQ(round_to(percent_g, 1189934.2), 1189930.0);
  EXPECT_EQ(step_at(percent_g, 1189934.2), 10.0);
  const NumberStyle java = style_of({"-5.8693124E-5", "7.0E-5", "1.25", "1.0E7", "0.001234"});
  EXPECT_EQ(format(java, 5.8e-5), "5.8E-5");
  EXPECT_EQ(round_to(java, 0.0), 0.0);
  EXPECT_GT(round_to(java, 1.79e308), 1e308);  // near the largest double
  EXPECT_EQ(format(java, 2.5e-3), "0.0025");
  EXPECT_EQ(format(java, 2.5e-4), "2.5E-4");
  EXPECT_EQ(format(java, 3e-4), "3.0E-4");
  EXPECT_EQ(format(java, 2.5e7), "2.5E7");
  const NumberStyle script = style_of({"1.25e-7", "0.0000125", "12500000", "0.5"});
  EXPECT_EQ(format(script, 2.5e-7), "2.5e-7");
  EXPECT_EQ(format(script, 2.5e-5), "0.000025");
  EXPECT_EQ(format(script, 22500000), "22500000");
  EXPECT_EQ(format(style_of({"+1.50", "-2.25", "+0.00"}), 3.5), "+3.50");
  EXPECT_EQ(format(style_of({"+1.50", "-2.25", "0.00"}), 3.5), "3.50");
  EXPECT_EQ(format(style_of({"1e5", "2.5e-3"}), 31250.0), "3.1e4");
}

TEST(LearnStyle, KeepsIntegersAndSmallHabits) {
  EXPECT_EQ(format(style_of({"1", "20", "-3"}), 4.6), "5");
  EXPECT_EQ(step_at(style_of({"1", "20", "-3"}), 4.6), 1.0);
  EXPECT_EQ(format(style_of({"1.0", "2.25", "0.5"}), 3.0), "3.0");
  EXPECT_EQ(format(style_of({".25", "-.75", "1.5"}), -0.5), "-.5");
  EXPECT_EQ(format(style_of({}), 2.4), "2");
}

TEST(LearnStyle, NeverPassesSeventeenDigits) {
  const NumberStyle style = style_of({"0.12345678901234567890123", "1.5"});
  EXPECT_EQ(style.significant, 17);
  EXPECT_EQ(format(style, 0.1).size(), std::string("0.10000000000000001").size());
}

TEST(FormatNumber, ReadsBackAsRounded) {
  const std::vector<std::vector<std::string_view>> files = {{"0.296502", "1.500000"},
                                                            {"0.296502", "12.5", "0.0123456"},
                                                            {"1.5e-05", "0.25", "17.125"},
                                                            {"1.0e+00", "2.5e-03"},
                                                            {"1", "2"},
                                                            {"0.12345678901234567", "1.5"},
                                                            {"1e-300", "1e300"},
                                                            {"0.1234567890123456", "3.25"},
                                                            {".5", "1.25e-9"},
                                                            {"-586931", "1.18669e+06", "0.5"},
                                                            {"5.8693124E-5", "1.25", "1.0E7"},
                                                            {"1.25e-7", "0.0000125", "125"},
                                                            {"+1.5", "-2.25e-05", "+1e+20"}};
  for (const auto& tokens : files) {
    const NumberStyle style = style_of(tokens);
    for (std::uint64_t i = 0; i < 4000; ++i) {
      double value =
          (random_unit(4, 5, i) - 0.5) * std::pow(10.0, static_cast<double>(i % 24) - 12);
      if (i % 50 == 0) value = std::bit_cast<double>(random_bits(4, 6, i));
      if (!std::isfinite(value)) continue;
      const double rounded = round_to(style, value);
      const std::string text = format(style, value);
      ASSERT_EQ(parse(text), rounded) << text;
      ASSERT_EQ(round_to(style, rounded), rounded) << text;
      ASSERT_FALSE(rounded == 0 && (std::signbit(rounded) || text[0] == '-')) << text;
      if (style.notation != Notation::Scientific && std::abs(value) > 1e-8) {
        ASSERT_LE(std::abs(rounded - value),
                  0.5000001 * step_at(style, value) + 2e-16 * std::abs(value))
            << text;
      }
    }
  }
}

TEST(FormatNumber, RoundsTiesOfTheExactValue) {
  const NumberStyle style = style_of({"0.123", "1.250", "7.000"});
  EXPECT_EQ(format(style, 0.0625), "0.062");  // exact tie, to even
  EXPECT_EQ(format(style, 1.0005), "1.000");  // the double lies below the tie
  EXPECT_EQ(format(style, 9.9996), "10.000");
}

TEST(ShowToken, IsShortAndPrintable) {
  const std::string text = std::string("a\x01") + std::string(100, 'b');
  const std::string shown = show_token(text.data(), text.data() + text.size());
  EXPECT_LT(shown.size(), 40U);
  EXPECT_EQ(shown.substr(0, 4), "'a?b");
}

}  // namespace
}  // namespace triglyph
