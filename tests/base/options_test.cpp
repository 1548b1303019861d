#include "engine/base/options.h"

#include <array>

#include <gtest/gtest.h>

#include "engine/base/error.h"

namespace triglyph {
namespace {

enum class Colour { Red, Green };
constexpr std::array<std::string_view, 2> kColours = {"red", "green"};

struct Settings {
  bool loud = false;
  int count = 1;
  std::optional<double> width;
  Colour colour = Colour::Red;
};

const OptionTable<Settings>& table() {
  static const OptionTable<Settings> options = {
      flag_option<Settings>("loud", &Settings::loud, "Be loud"),
      count_option<Settings>("count", &Settings::count, {1, 9}, "", "1", "How many"),
      number_option<Settings>("line_width", &Settings::width, {0, 5, true}, "mm", "none", "Width"),
      choice_option<Settings>("colour", &Settings::colour, kColours, "red", "Colour")};
  return options;
}

Settings with(const OptionValues& values) {
  Settings settings;
  apply_options(table(), values, settings);
  return settings;
}

TEST(Options, ApplyAndComeBack) {
  const OptionValues values = {{"loud", true},
                               {"count", std::int64_t{4}},
                               {"line_width", 2.5},
                               {"colour", std::string("green")}};
  const Settings settings = with(values);
  EXPECT_TRUE(settings.loud);
  EXPECT_EQ(settings.count, 4);
  EXPECT_EQ(settings.width, 2.5);
  EXPECT_EQ(settings.colour, Colour::Green);
  EXPECT_EQ(option_values(table(), settings), values);
  EXPECT_FALSE(option_values(table(), Settings{}).contains("line_width"));  // was never chosen
}

TEST(Options, AWholeNumberServesAsARealOne) {
  EXPECT_EQ(with({{"line_width", std::int64_t{3}}}).width, 3.0);
}

TEST(Options, RefuseOtherTypesAndValuesOutOfRangeNamingTheKey) {
  const OptionValues wrong[] = {{{"loud", std::int64_t{1}}},
                                {{"count", std::int64_t{0}}},
                                {{"count", std::int64_t{10}}},
                                {{"count", 2.0}},
                                {{"line_width", 0.0}},
                                {{"line_width", 5.1}},
                                {{"line_width", std::string("2")}},
                                {{"colour", std::string("blue")}},
                                {{"colour", std::int64_t{0}}}};
  for (const OptionValues& values : wrong) {
    try {
      (void)with(values);
      ADD_FAILURE() << values.begin()->first;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("\"" + values.begin()->first + "\""),
                std::string::npos)
          << error.what();
    }
  }
}

TEST(Options, TextIsReadAsTheOptionsKind) {
  const auto parsed = [](const char* key, const char* text) {
    return find_option(table(), key)->spec.parsed(text);
  };
  EXPECT_EQ(parsed("count", "7"), OptionValue(std::int64_t{7}));
  EXPECT_EQ(parsed("line_width", "0.1"), OptionValue(0.1));
  EXPECT_EQ(parsed("loud", "true"), OptionValue(true));
  for (const char* text : {"", "7x", "2.5", "nan", "0x5", " 7", "10"}) {
    EXPECT_THROW((void)parsed("count", text), Error) << text;
  }
  for (const char* text : {"nan", "inf", "-1", "1e9"}) {
    EXPECT_THROW((void)parsed("line_width", text), Error) << text;
  }
  for (const OptionValue& value :
       {OptionValue(true), OptionValue(0.1), OptionValue(std::int64_t{-3})}) {
    EXPECT_FALSE(to_text(value).empty());
  }
  EXPECT_EQ(find_option(table(), "line_width")->spec.flag(), "--line-width");
}

TEST(Options, SayTheirRangeInWords) {
  const auto spec = [](const char* key) { return find_option(table(), key)->spec; };
  EXPECT_EQ(spec("line_width").domain(), "a number above 0 to 5 mm");
  EXPECT_EQ(spec("line_width").range_text(), "above 0 to 5 mm");
  EXPECT_EQ(spec("count").domain(), "a whole number from 1 to 9");
  EXPECT_EQ(spec("colour").domain(), "one of red, green");
  EXPECT_EQ(spec("colour").range_text(), "");
  OptionSpec open{"size", OptionKind::Count, "rings", {2, 1e6}, {}, "", "Size"};
  EXPECT_EQ(open.range_text(), "2 to 1000000 rings");
  open.range = {2};
  EXPECT_EQ(open.domain(), "a whole number of at least 2 rings");
}

}  // namespace
}  // namespace triglyph
