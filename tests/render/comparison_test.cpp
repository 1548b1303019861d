#include "render/comparison.h"

#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "render/colours.h"
#include "render/paper_figure.h"
#include "render/ray_caster.h"
#include "tests/support/arenas.h"
#include "tests/support/motions.h"
#include "tests/support/remeshing.h"
#include "tests/support/shapes.h"

namespace triglyph {
namespace {

double share_of_blue(const Image& image, int left, int right) {
  int blue = 0;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = left; x < right; ++x) {
      const Colour& c = image.at(x, y);
      if (c.blue > 1.5F * c.red && c.blue > 0.05F) ++blue;
    }
  }
  return static_cast<double>(blue) / (image.height() * (right - left));
}

PictureOptions small() {
  PictureOptions options;
  options.width = 150;
  options.samples = 4;
  return options;
}

TEST(MovedFacets, AreThoseWithAPointThatMoved) {
  const Mesh sheet = test::flat_grid(3, 1);
  Mesh moved = sheet;
  moved.positions[0] += Vec3(0, 0, 0.1);
  const std::vector<bool> is_moved = moved_facets(sheet, moved);
  for (std::size_t t = 0; t < is_moved.size(); ++t) {
    const Triangle& c = sheet.triangles[t];
    EXPECT_EQ(is_moved[t], c[0] == 0 || c[1] == 0 || c[2] == 0);
  }
}

TEST(Distances, HaveTheSignOfTheSide) {
  const Mesh sheet = test::flat_grid(4, 4);
  Mesh lifted = sheet;
  lifted.positions[6] += Vec3(0, 0, 0.3);
  lifted.positions[12] -= Vec3(0, 0, 0.2);
  const std::vector<double> plain = distances(sheet, lifted, false);
  const std::vector<double> with_sign = distances(sheet, lifted, true);
  EXPECT_NEAR(plain[6], 0.3, 1e-12);
  EXPECT_NEAR(plain[12], 0.2, 1e-12);
  EXPECT_NEAR(with_sign[6], 0.3, 1e-12);
  EXPECT_NEAR(with_sign[12], -0.2, 1e-12);
  EXPECT_EQ(plain[0], 0);
}

// Points that no triangle uses are not seen: neither the view nor the scale is theirs.
TEST(Distances, AreNoneOfStrayPoints) {
  const Mesh sheet = test::flat_grid(4, 4);
  Mesh with_stray = sheet;
  with_stray.positions.emplace_back(1e6, 0, 0);
  EXPECT_EQ(distances(sheet, with_stray, false).back(), 0);
  const PictureOptions options = drawable(with_stray, small());
  EXPECT_EQ(options.height, drawable(sheet, small()).height);
  const Camera camera = camera_for(sheet, options), other = camera_for(with_stray, options);
  EXPECT_EQ(camera.centre, other.centre);
  EXPECT_EQ(camera.half_height, other.half_height);
}

// The shaded facets of the picture are the moved ones: the blue area is theirs.
TEST(DrawComparison, ShadesTheFacetsThatMoved) {
  const Mesh sheet = test::flat_grid(10, 10);
  Mesh moved = sheet;
  moved.positions[60] += Vec3(0, 0, 1e-3);  // inner: six facets of half a square
  PictureOptions options = small();
  options.view = "front";
  options.height = 150;
  const Image picture = draw_comparison(sheet, moved, {"facets"}, options);
  const double pixels =
      share_of_blue(picture, 0, picture.width()) * picture.width() * picture.height();
  const double side = 150 / (10 * 1.06);
  EXPECT_NEAR(pixels, 3 * side * side, 0.12 * pixels);
  const Image unmoved = draw_comparison(sheet, sheet, {"facets"}, options);
  EXPECT_EQ(share_of_blue(unmoved, 0, unmoved.width()), 0);
}

TEST(DrawComparison, DrawsEveryPanelAlsoOfOtherTessellations) {
  const Mesh& ball = test::bumpy_ball().mesh;
  const Mesh shaken = test::shaken(ball, 0.005, 1);
  const Mesh coarse = test::decimated(ball, 0.5);
  for (const std::string_view name : panel_names()) {
    for (const Mesh* second : {&shaken, &coarse}) {
      const Image picture = draw_comparison(ball, *second, {std::string(name)}, small());
      std::size_t drawn = 0;
      for (const Colour& pixel : picture.pixels()) drawn += pixel.red < 0.9F ? 1 : 0;
      EXPECT_GT(drawn, picture.pixels().size() / 5) << name;
    }
  }
}

TEST(DrawComparison, HasAsManyPanelsAsAreAskedFor) {
  const Mesh globe = test::sphere(12, 1);
  std::vector<std::string> panels;
  int last = 0;
  for (std::size_t count = 1; count <= 6; ++count) {
    panels.emplace_back(panel_names()[count % panel_names().size()]);
    const Image picture = draw_comparison(globe, globe, panels, small());
    EXPECT_GT(picture.width() * picture.height(), last) << count;
    last = count == 4 || count == 5 ? last : picture.width() * picture.height();
  }
  panels.emplace_back("original");
  EXPECT_THROW((void)draw_comparison(globe, globe, panels, small()), Error);
  EXPECT_THROW((void)draw_comparison(globe, globe, {}, small()), Error);
  EXPECT_THROW((void)draw_comparison(globe, globe, {"beauty"}, small()), Error);
}

TEST(DrawComparison, RefusesWhatCannotBeDrawn) {
  const Mesh globe = test::sphere(12, 1);
  EXPECT_THROW((void)draw_comparison({}, globe, {"original"}, small()), Error);
  EXPECT_THROW((void)draw_comparison(globe, {}, {"original"}, small()), Error);
  PictureOptions options = small();
  options.width = 10;
  EXPECT_THROW((void)draw_comparison(globe, globe, {"original"}, options), Error);
  options = small();
  options.samples = 0;
  EXPECT_THROW((void)draw_comparison(globe, globe, {"original"}, options), Error);
}

TEST(DrawComparison, DrawsDegenerateMeshes) {
  const Mesh line{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(2, 0, 0)}, {{0, 1, 2}}};
  const Mesh far{{Vec3(1e9, 0, 0), Vec3(1e9 + 1, 0, 0), Vec3(1e9, 1, 0)}, {{0, 1, 2}}};
  for (const Mesh* mesh : {&line, &far}) {
    for (const std::string_view name : panel_names()) {
      EXPECT_GT(draw_comparison(*mesh, *mesh, {std::string(name)}, small()).width(), 0);
    }
  }
}

TEST(Drawable, ChoosesTheHeightThatTheMeshNeeds) {
  const Mesh tall = test::tube(40, 4, 1, 10);
  PictureOptions options = small();
  options.view = "front-z";
  EXPECT_GT(drawable(tall, options).height, options.width);
  options.view = "90,90-z";
  const int flat = drawable(tall, options).height;
  EXPECT_NEAR(flat, options.width, 2);
  options.height = 77;
  EXPECT_EQ(drawable(tall, options).height, 77);
}

class PaperFigure : public ::testing::TestWithParam<const char*> {};

TEST_P(PaperFigure, ShowsTheMarkInTwoOfThreePanels) {
  const Mesh& ball =
      std::string(GetParam()) == "iie" ? test::large_ball().mesh : test::bumpy_ball().mesh;
  const Image figure = draw_paper_figure(ball, GetParam(), small());
  const int third = figure.width() / 3;
  const auto is_marked = [&](int left) {
    int marked = 0;
    for (int y = 0; y < figure.height(); ++y) {
      for (int x = left; x < left + third; ++x) {
        const Colour& c = figure.at(x, y);
        const bool blue = c.blue > 1.5F * c.red && c.blue > 0.05F;
        const bool green = c.green > 1.2F * c.red && c.green > 1.1F * c.blue;
        marked += blue || green ? 1 : 0;
      }
    }
    return marked;
  };
  EXPECT_EQ(is_marked(0), 0);
  EXPECT_GT(is_marked(third), 100);
  EXPECT_GT(is_marked(2 * third), is_marked(third));  // more units
}

INSTANTIATE_TEST_SUITE_P(All, PaperFigure, ::testing::Values("tsq", "aie", "iie"),
                         [](const auto& name) { return name.param; });

TEST(DrawPaperFigure, RefusesAnUnknownScheme) {
  EXPECT_THROW((void)draw_paper_figure(test::sphere(12, 1), "qim", small()), Error);
}

}  // namespace
}  // namespace triglyph
