#include "engine/marking/options.h"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "engine/marking/mark_file.h"
#include "engine/scheme/registry.h"

namespace triglyph {
namespace {

OptionValues with_message(OptionValues values) {
  values.emplace("message", std::string("m"));
  return values;
}

TEST(MarkOptions, EveryOptionIsDeclaredOnceAndSaysWhatItIs) {
  std::set<std::string> keys;
  for (const OptionSpec& spec : mark_option_specs()) {
    EXPECT_TRUE(keys.insert(spec.key).second) << spec.key;
    EXPECT_FALSE(spec.help.empty()) << spec.key;
    EXPECT_EQ(find_mark_option(spec.key), &spec);
  }
  EXPECT_EQ(find_mark_option("no_such"), nullptr);
  for (const std::string_view scheme : scheme_names()) {
    for (const OptionSpec& spec : scheme_info(scheme).options) {
      EXPECT_NE(find_mark_option(spec.key), nullptr) << spec.key;
    }
  }
}

// What a record writes down is all that a reader, or a second run, needs.
TEST(MarkOptions, ValuesResolveToTheOptionsTheyCameFrom) {
  for (const std::string_view scheme : scheme_names()) {
    OptionValues values = with_message({{"scheme", std::string(scheme)},
                                        {"step", 0.0125},
                                        {"layout", std::string("local-search")},
                                        {"layout_seed", std::int64_t{77}},
                                        {"max_move", 0.3},
                                        {"drop_dearest", 12.5},
                                        {"redundancy", std::int64_t{9}},
                                        {"cost", std::string("normal")},
                                        {"part_bits", std::int64_t{8}}});
    const MarkOptions options = resolve(values).options;
    EXPECT_EQ(resolve(with_message(values_of(options))).options, options) << scheme;
    EXPECT_EQ(options.layout.seed, 77U);
    EXPECT_EQ(options.max_move_percent, 0.3);
    EXPECT_EQ(options.cost, CostFunction::Normal);
    EXPECT_EQ(number_in(options.scheme_options, "step", 0), 0.0125);
  }
}

TEST(MarkOptions, ValuesNameALimitOfMovesOnlyIfOneWasGiven) {
  EXPECT_FALSE(values_of(resolve(with_message({})).options).contains("max_move"));
  const MarkOptions none = resolve(with_message({{"max_move", 0.0}})).options;
  EXPECT_EQ(values_of(none).at("max_move"), OptionValue(0.0));
}

TEST(MarkOptions, AMessageInAnyFormReplacesOneInAnyOther) {
  const OptionValues base = with_message({{"redundancy", std::int64_t{3}}});
  const MarkRequest hex = resolve(layered(base, {{"message_hex", std::string("00ff")}}));
  EXPECT_EQ(hex.message(), (Message{0, 255}));
  EXPECT_EQ(hex.options.redundancy, 3U);
  EXPECT_TRUE(resolve(layered(base, {{"fill", true}})).is_fill());
  EXPECT_EQ(resolve(layered(base, {{"fill", false}})).message(), (Message{'m'}));
  EXPECT_THROW((void)resolve({}), Error);
  EXPECT_THROW((void)resolve({{"message", std::string()}}), Error);
  EXPECT_THROW((void)resolve({{"message_hex", std::string()}}), Error);
}

TEST(MarkOptions, AMissingMessageIsRefusedWithItsForms) {
  try {
    (void)resolve({{"fill", false}});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::Usage);
    EXPECT_STREQ(error.what(), "no message: give --message, --message-hex, --recipient or --fill");
  }
  EXPECT_EQ(find_mark_option("message")->default_text, "");
}

TEST(MarkOptions, OptionsOfAnotherSchemeContradictTheSchemeInUse) {
  EXPECT_THROW(check_contradictions({{"radius", 1.0}}, "tsq"), Error);
  EXPECT_NO_THROW(check_contradictions({{"radius", 1.0}}, "iie"));
  EXPECT_NO_THROW(check_contradictions({{"radius", 1.0}}, ""));
  EXPECT_NO_THROW(check_contradictions({{"step", 0.01}}, "aie"));
}

TEST(MarkOptions, AReaderThatIsToldNothingTriesEveryScheme) {
  const std::vector<Encoding> all = encodings_of({});
  // tsq and its strong marks, flux, aie, iie, its older generation, its strong marks
  ASSERT_EQ(all.size(), 7U);
  EXPECT_EQ(all[2].scheme, kFluxScheme);
  for (const std::string_view scheme : scheme_names()) {
    for (const Strength strength : {Strength::Light, Strength::Normal, Strength::Strong}) {
      const Encoding encoding = default_mark_options(scheme, false, strength).encoding();
      EXPECT_EQ(std::count(all.begin(), all.end(), encoding), 1) << scheme;
    }
  }
  const std::vector<Encoding> iie = encodings_of({{"scheme", std::string("iie")}});
  EXPECT_EQ(iie, std::vector<Encoding>(all.end() - 3, all.end()));
  EXPECT_EQ(encodings_of({{"scheme", std::string("flux")}}).size(), 1U);
  EXPECT_EQ(encodings_of({{"scheme", std::string("flux+iie")}}).size(), 4U);
}

// Old marks first-generation options were recorded for are found without naming the generation.
TEST(MarkOptions, OptionsOfAReaderApplyToEveryGeneration) {
  const std::vector<Encoding> both =
      encodings_of({{"scheme", std::string("iie")}, {"radius", 0.25}});
  ASSERT_EQ(both.size(), 3U);
  EXPECT_TRUE(both[0].format.is_spread);
  EXPECT_EQ(both[1].format, (WordFormat{0, 5, 4}));
  EXPECT_EQ(both[1].scheme_options.at("step"), OptionValue(0.007));
  for (const Encoding& encoding : both) {
    EXPECT_EQ(encoding.scheme_options.at("radius"), OptionValue(0.25));
  }
  // and what one names holds for all
  const std::vector<Encoding> global =
      encodings_of({{"scheme", std::string("iie")}, {"iie_encoding", std::string("global")}});
  EXPECT_EQ(std::count(global.begin(), global.end(),
                       encodings_of({{"scheme", std::string("iie")}}).at(1)),
            1);
  for (const Encoding& encoding : global) EXPECT_FALSE(encoding.format.is_spread);
}

// A message that is too long for the strong format is marked with bits that number its parts.
TEST(MarkOptions, AStrongMarkHoldsAnyMessage) {
  const OptionValues strong = {{"scheme", std::string("tsq")}, {"strength", std::string("strong")}};
  const auto resolved = [&](std::size_t bytes) {
    OptionValues values = strong;
    values.emplace("message", std::string(bytes, 'm'));
    return resolve(values).options;
  };
  const MarkOptions usual = default_mark_options("tsq", false);
  for (const std::size_t bytes : {1U, 16U, 27U, 28U, 256U}) {
    const MarkOptions options = resolved(bytes);
    EXPECT_EQ(options.redundancy, 0U);
    EXPECT_EQ(options.encoding() == usual.encoding(), bytes > 27) << bytes;
    const std::vector<Encoding> tried = encodings_of({});
    EXPECT_EQ(std::count(tried.begin(), tried.end(), options.encoding()), 1) << bytes;
  }
}

TEST(EstimateMemory, KnowsFormatsInAnyCaseAndTheCostsOfFill) {
  constexpr std::uint64_t kFile = 2'700'000;  // a bunny's
  EXPECT_EQ(estimate_memory(kFile, "a.PLY", MeshWork::Usual),
            estimate_memory(kFile, "a.ply", MeshWork::Usual));
  EXPECT_GT(estimate_memory(kFile, "a.ply", MeshWork::Usual),
            estimate_memory(kFile, "a.obj", MeshWork::Usual));
  // 5,300 units under as many words: two matrices of 114 MB
  EXPECT_GT(estimate_memory(kFile, "a.obj", MeshWork::Fill), std::uint64_t{2} * 114'000'000);
  // larger ones are dealt into blocks of 2^26 pairs
  EXPECT_LT(estimate_memory(1'000'000'000, "a.obj", MeshWork::Fill),
            estimate_memory(1'000'000'000, "a.obj", MeshWork::Usual) + (std::uint64_t{1} << 30));
  // what marking the bunny, cut into 1.1 million triangles, took at its peak
  EXPECT_GT(estimate_memory(48'064'271, "a.obj", MeshWork::Flux), 676'278'272U);
}

}  // namespace
}  // namespace triglyph
