#include "render/picture_file.h"

#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "render/colours.h"
#include "render/panels.h"
#include "tests/support/temp_folder.h"

namespace triglyph {
namespace {

namespace fs = std::filesystem;

Image gradient() {
  Image image(40, 30);
  for (int y = 0; y < 30; ++y) {
    for (int x = 0; x < 40; ++x) {
      image.at(x, y) = {static_cast<float>(x) / 40, static_cast<float>(y) / 30, 0.25F, 1};
    }
  }
  image.at(3, 4) = {0, 0, 0, 0};
  return image;
}

float difference(const Image& a, const Image& b) {
  float greatest = 0;
  for (std::size_t i = 0; i < a.pixels().size(); ++i) {
    const Colour& p = a.pixels()[i];
    const Colour& q = b.pixels()[i];
    greatest = std::max({greatest, std::abs(encode_srgb(p.red) - encode_srgb(q.red)),
                         std::abs(encode_srgb(p.green) - encode_srgb(q.green)),
                         std::abs(encode_srgb(p.blue) - encode_srgb(q.blue))});
  }
  return greatest;
}

class PictureFile : public ::testing::Test {
 protected:
  test::TempFolder folder_;
};

TEST_F(PictureFile, ComesBackAsItWasWritten) {
  const Image image = gradient();
  for (const char* name : {"a.png", "a.exr", "deep/er/a.PNG"}) {
    write_picture(image, folder_ / name);
    const Image back = read_picture(folder_ / name);
    ASSERT_EQ(back.width(), 40) << name;
    ASSERT_EQ(back.height(), 30) << name;
    EXPECT_LE(difference(image, back), 0.0025F) << name;
    EXPECT_EQ(back.at(3, 4).alpha, 0) << name;
    EXPECT_EQ(back.at(4, 4).alpha, 1) << name;
  }
}

TEST_F(PictureFile, OfJpegIsOnWhite) {
  const Image clear(32, 32);
  write_picture(clear, folder_ / "a.jpg");
  EXPECT_GT(read_picture(folder_ / "a.jpg").at(16, 16).red, 0.98F);
}

TEST_F(PictureFile, IsRefusedUnderAnUnknownName) {
  for (const char* name : {"a.gif", "a", "a.obj", "png"}) {
    EXPECT_THROW(write_picture(gradient(), folder_ / name), Error) << name;
    EXPECT_FALSE(fs::exists(folder_ / name));
  }
}

TEST_F(PictureFile, ThatCannotBeWrittenLeavesNothing) {
  folder_.write("file", "");
  try {
    write_picture(gradient(), folder_ / "file" / "a.png");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::Unwritable);
  }
  EXPECT_THROW((void)read_picture(folder_ / "absent.png"), Error);
}

// Ink inside the given columns, and none outside.
void expect_ink_between(const Image& image, int left, int right) {
  bool has_ink = false;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      if (image.at(x, y).red > 0.5F) continue;
      has_ink = true;
      EXPECT_GE(x, left);
      EXPECT_LT(x, right);
    }
  }
  EXPECT_TRUE(has_ink);
}

TEST(DrawText, AnchorsAndStaysWithinItsWidth) {
  const Colour white{1, 1, 1, 1};
  Image left(300, 40, white), middle(300, 40, white), right(300, 40, white), tight(300, 40, white);
  draw_text("label", 10, 20, {20, 300, TextAnchor::Left}, left);
  draw_text("label", 150, 20, {20, 300, TextAnchor::Middle}, middle);
  draw_text("label", 290, 20, {20, 300, TextAnchor::Right}, right);
  draw_text("a label that is far too long for its place", 150, 20, {20, 180, TextAnchor::Middle},
            tight);
  expect_ink_between(left, 9, 80);
  expect_ink_between(middle, 115, 185);
  expect_ink_between(right, 220, 292);
  expect_ink_between(tight, 55, 245);
}

TEST(Arrange, PutsPanelsInAGrid) {
  const Colour white{1, 1, 1, 1};
  const Colour blue = from_srgb(kMarkBlue);
  for (std::size_t count = 1; count <= 6; ++count) {
    std::vector<Panel> panels;
    for (std::size_t i = 0; i < count; ++i) {
      panels.push_back({"title", "note", Image(100, 80, blue), std::nullopt});
    }
    const Image picture = arrange(panels, white);
    const int columns = columns_of(count);
    const int rows = static_cast<int>((count + static_cast<std::size_t>(columns) - 1) /
                                      static_cast<std::size_t>(columns));
    EXPECT_GE(picture.width(), columns * 100);
    EXPECT_LE(picture.width(), columns * 120 + 20);
    std::size_t shown = 0;
    for (const Colour& pixel : picture.pixels()) {
      if (std::abs(pixel.blue - blue.blue) < 1e-4F && pixel.red < 0.1F) ++shown;
    }
    EXPECT_GE(shown, count * 100 * 80);  // none covers another
    EXPECT_GE(picture.height(), rows * 80);
  }
}

TEST(Arrange, DrawsTheScaleFromLeastToGreatest) {
  const std::vector<Panel> panels = {{"heat", "", Image(200, 50), Scale{0.5, false}}};
  const Image picture = arrange(panels, {1, 1, 1, 1});
  // the bar's colours appear in order
  const auto column_of = [&](const Colour& colour) {
    for (int x = 0; x < picture.width(); ++x) {
      for (int y = 90; y < picture.height(); ++y) {
        const Colour& pixel = picture.at(x, y);
        if (std::abs(pixel.red - colour.red) + std::abs(pixel.green - colour.green) +
                std::abs(pixel.blue - colour.blue) <
            0.02F) {
          return x;
        }
      }
    }
    return -1;
  };
  const int low = column_of(heat_colour(0.1));
  const int high = column_of(heat_colour(0.9));
  EXPECT_GT(low, 0);
  EXPECT_NEAR(high - low, 0.8 * 0.75 * 200, 3);
}

TEST(ShortNumber, HasThreeDigits) {
  EXPECT_EQ(short_number(0), "0");
  EXPECT_EQ(short_number(0.038712), "0.0387");
  EXPECT_EQ(short_number(-12.3456), "-12.3");
}

}  // namespace
}  // namespace triglyph
