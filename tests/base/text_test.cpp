#include "engine/base/text.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace triglyph {
namespace {

TEST(ClosestWord, ForgivesAThirdOfTheLetters) {
  const std::vector<std::string> known{"noise", "smooth", "quantise", "flip"};
  EXPECT_EQ(closest_word("nosie", known), "noise");  // swapped
  EXPECT_EQ(closest_word("smoth", known), "smooth");
  EXPECT_EQ(closest_word("quantize", known), "quantise");
  EXPECT_EQ(closest_word("flip", known), "flip");
  EXPECT_EQ(closest_word("flap", known), "flip");
  EXPECT_EQ(closest_word("flaw", known), std::nullopt);  // two of four
  EXPECT_EQ(closest_word("", known), std::nullopt);
  EXPECT_EQ(closest_word("noise", {}), std::nullopt);
}

TEST(ClosestWord, OfEquallyCloseOnesIsTheFirst) {
  const std::vector<std::string> known{"crop", "drop"};
  EXPECT_EQ(closest_word("frop", known), "crop");
}

}  // namespace
}  // namespace triglyph
