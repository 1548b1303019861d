#include "render/ray_caster.h"

#include <gtest/gtest.h>

#include "render/colours.h"
#include "tests/support/arenas.h"
#include "tests/support/motions.h"
#include "tests/support/shapes.h"

namespace triglyph {
namespace {

bool is_blue(const Colour& colour) {
  return colour.alpha > 0.9F && colour.blue > 1.5F * colour.red;
}
bool is_green(const Colour& colour) {
  return colour.green > 1.15F * colour.red && colour.green > 1.1F * colour.blue;
}

TEST(Colours, EncodeAndDecodeAreInverse) {
  for (float share = 0; share <= 1; share += 0.01F) {
    EXPECT_NEAR(decode_srgb(encode_srgb(share)), share, 1e-5F);
  }
  EXPECT_NEAR(from_srgb(0xff8000).red, 1, 1e-6F);
  EXPECT_NEAR(encode_srgb(from_srgb(0xff8000).green), 128 / 255.0F, 1e-5F);
}

TEST(HeatColour, IsDarkerTheMoreThereIs) {
  const auto brightness = [](const Colour& c) {
    return 0.2126F * c.red + 0.7152F * c.green + 0.0722F * c.blue;
  };
  for (double share = 0.08; share < 1; share += 0.01) {
    EXPECT_LT(brightness(heat_colour(share + 0.01)), brightness(heat_colour(share)));
  }
  EXPECT_EQ(heat_colour(7).red, heat_colour(1).red);
  EXPECT_GT(signed_colour(0.5).red, signed_colour(0.5).blue);
  EXPECT_LT(signed_colour(-0.5).red, signed_colour(-0.5).blue);
}

TEST(RayCaster, SeesASphereAsADisc) {
  const Mesh globe = test::sphere(90, 2);
  const Scene scene(globe, false);
  const Camera camera = whole_view(globe.positions, view_named("20,15"), 1);
  const Image image = RayCaster(scene).draw(camera, 200, 200, 16);
  double covered = 0;
  for (const Colour& pixel : image.pixels()) covered += pixel.alpha;
  const double radius = 100 * 2 / camera.half_height;
  EXPECT_NEAR(covered, M_PI * radius * radius, 0.005 * covered);
  EXPECT_EQ(image.at(100, 100).alpha, 1);
  EXPECT_EQ(image.at(2, 2).alpha, 0);
  // light comes from the upper left
  EXPECT_GT(image.at(70, 70).green, image.at(130, 130).green);
}

// What is drawn is where it is: every facet of a sheet has its own colour at its centroid.
TEST(RayCaster, DrawsEveryFacetInItsPlaceAndColour) {
  const Mesh sheet = test::flat_grid(6, 5);
  Scene scene(sheet, true);
  for (std::size_t t = 0; t < sheet.triangles.size(); ++t) {
    scene.face_colours.push_back(from_srgb(t % 3 == 0 ? kMarkBlue : kClay));
  }
  const Camera camera = whole_view(sheet.positions, view_named("front"), 1.5);
  const Image image = RayCaster(scene).draw(camera, 300, 200, 16);
  for (std::size_t t = 0; t < sheet.triangles.size(); ++t) {
    const Triangle& c = sheet.triangles[t];
    const Vec3 centroid =
        (sheet.positions[c[0]] + sheet.positions[c[1]] + sheet.positions[c[2]]) / 3;
    const Vec3 offset = (centroid - camera.centre) / camera.half_height * 100;
    const auto x = static_cast<int>(150 + dot(offset, camera.right));
    const auto y = static_cast<int>(100 - dot(offset, camera.up));
    EXPECT_EQ(is_blue(image.at(x, y)), t % 3 == 0) << t;
  }
}

TEST(RayCaster, BlendsPointColoursAcrossAFacet) {
  const Mesh sheet = test::flat_grid(1, 1);
  Scene scene(sheet, true);
  scene.point_colours = {from_srgb(0xff0000), from_srgb(0x0000ff), from_srgb(0xff0000),
                         from_srgb(0x0000ff)};
  const Camera camera = whole_view(sheet.positions, view_named("front"), 1);
  const Image image = RayCaster(scene).draw(camera, 100, 100, 16);
  EXPECT_GT(image.at(8, 90).red, 5 * image.at(8, 90).blue);    // point 0
  EXPECT_GT(image.at(92, 90).blue, 5 * image.at(92, 90).red);  // point 1
  EXPECT_NEAR(image.at(50, 92).red, image.at(50, 92).blue, 0.1F);
}

TEST(RayCaster, DrawsDotsSolidAndBallsTranslucent) {
  const Mesh sheet = test::flat_grid(4, 4);
  Scene scene(sheet, true);
  scene.dots.push_back({Vec3(1, 2, 0), 0.2});
  scene.balls.push_back({Vec3(3, 2, 0), 0.5});
  scene.balls.push_back({Vec3(2, 3.9, -5), 0.5});  // hidden
  const Camera camera = whole_view(sheet.positions, view_named("front"), 1);
  const Image image = RayCaster(scene).draw(camera, 200, 200, 16);
  const auto pixel = [&](double x, double y) {
    return image.at(static_cast<int>(100 + (x - 2) / camera.half_height * 100),
                    static_cast<int>(100 - (y - 2) / camera.half_height * 100));
  };
  EXPECT_TRUE(is_blue(pixel(1, 2)));
  EXPECT_FALSE(is_blue(pixel(1.3, 2)));
  EXPECT_TRUE(is_green(pixel(3, 2)));
  EXPECT_FALSE(is_green(pixel(3, 2.6)));
  EXPECT_FALSE(is_green(pixel(2, 3.9)));
}

TEST(RayCaster, DrawsEdgesWhereFacetsMeet) {
  const Mesh sheet = test::flat_grid(2, 2);
  Scene scene(sheet, true);
  scene.edge_width = 0.1;
  const Camera camera = whole_view(sheet.positions, view_named("front"), 1);
  const Image image = RayCaster(scene).draw(camera, 100, 100, 16);
  const float on_edge = image.at(50, 30).green;  // x = 1
  const float in_face = image.at(60, 12).green;
  EXPECT_LT(on_edge, 0.8F * in_face);
}

TEST(RayCaster, DoesNotDependOnThreads) {
  const Mesh& ball = test::bumpy_ball().mesh;
  const Scene scene(ball, false);
  const Camera camera = whole_view(ball.positions, automatic_view(ball), 1);
  test::expect_same_for_any_threads([&] {
    const Image image = RayCaster(scene).draw(camera, 120, 120, 20);
    std::vector<float> values;
    for (const Colour& c : image.pixels()) values.insert(values.end(), {c.red, c.green, c.alpha});
    return values;
  });
}

TEST(SmoothNormals, RoundOffABallButNotABox) {
  const Mesh globe = test::sphere(40, 1);
  const std::vector<Vec3> normals = smooth_normals(globe);
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const Vec3& point = globe.positions[globe.triangles[i / 3][i % 3]];
    EXPECT_GT(dot(normals[i], point), 0.995);
  }
  const Mesh corner = test::tetrahedron();
  const std::vector<Vec3> sharp = smooth_normals(corner);
  const std::vector<Vec3> flat = flat_normals(corner);
  for (std::size_t i = 0; i < sharp.size(); ++i) {
    EXPECT_NEAR((sharp[i] - flat[i / 3]).norm(), 0, 1e-12);
  }
}

}  // namespace
}  // namespace triglyph
