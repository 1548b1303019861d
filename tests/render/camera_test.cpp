#include "render/camera.h"

#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "tests/support/motions.h"
#include "tests/support/shapes.h"

namespace triglyph {
namespace {

TEST(ViewNamed, KnowsSidesAndAngles) {
  EXPECT_EQ(view_named("left").azimuth, -90);
  EXPECT_EQ(view_named("top").elevation, 90);
  EXPECT_EQ(view_named("front-z").vertical, 'z');
  EXPECT_EQ(view_named("30,-12.5").azimuth, 30);
  EXPECT_EQ(view_named("30,-12.5,z").elevation, -12.5);
  for (const char* name : {"", "up", "30", "30,", "a,b", "1,2,3", "nan,0", "30,20z"}) {
    EXPECT_THROW((void)view_named(name), Error) << name;
  }
}

TEST(WholeView, ShowsAllPointsAndFillsThePicture) {
  const Mesh& ball = test::bumpy_ball().mesh;
  for (const char* name : {"front", "back", "left", "top", "33,21", "10,-80,z"}) {
    for (const double aspect : {0.5, 1.0, 2.5}) {
      const Camera camera = whole_view(ball.positions, view_named(name), aspect);
      EXPECT_NEAR(dot(camera.right, camera.up), 0, 1e-12);
      EXPECT_NEAR(camera.towards_viewer().norm(), 1, 1e-12);
      double farthest = 0;
      for (const Vec3& point : ball.positions) {
        const Vec3 offset = point - camera.centre;
        farthest = std::max({farthest, std::abs(dot(offset, camera.up)) / camera.half_height,
                             std::abs(dot(offset, camera.right)) / (camera.half_height * aspect)});
      }
      EXPECT_LT(farthest, 1) << name;
      EXPECT_GT(farthest, 0.9) << name;
    }
  }
}

TEST(WholeView, FromTheFrontHasYUpAndXToTheRight) {
  const Camera camera = whole_view(test::tetrahedron().positions, view_named("front"), 1);
  EXPECT_NEAR((camera.right - Vec3(1, 0, 0)).norm(), 0, 1e-12);
  EXPECT_NEAR((camera.up - Vec3(0, 1, 0)).norm(), 0, 1e-12);
  const Camera z_up = whole_view(test::tetrahedron().positions, view_named("front-z"), 1);
  EXPECT_NEAR((z_up.right - Vec3(1, 0, 0)).norm(), 0, 1e-12);
  EXPECT_NEAR((z_up.up - Vec3(0, 0, 1)).norm(), 0, 1e-12);
}

// Sheets in all three planes: none is seen from its edge.
TEST(AutomaticView, ShowsMostOfTheSurface) {
  for (int axis = 0; axis < 3; ++axis) {
    Mesh sheet = test::flat_grid(4, 4);
    for (Vec3& p : sheet.positions)
      p = axis == 0 ? Vec3(0, p[0], p[1]) : axis == 1 ? Vec3(p[1], 0, p[0]) : p;
    Vec3 normal(0, 0, 0);
    normal[static_cast<std::size_t>(axis)] = 1;
    const Camera camera = whole_view(sheet.positions, automatic_view(sheet), 1);
    EXPECT_GT(std::abs(dot(camera.towards_viewer(), normal)), 0.7) << axis;
  }
}

TEST(CloseView, LooksAlongTheNormalAtThePlace) {
  const Camera like = whole_view(test::tetrahedron().positions, view_named("front"), 1);
  for (const Vec3& normal : {Vec3(0, 0, 2), Vec3(1, 2, 3), Vec3(0, 1, 0), Vec3(0, -5, 0.1)}) {
    const Camera close = close_view(Vec3(1, 2, 3), normal, 0.25, like);
    EXPECT_NEAR((close.towards_viewer() - normal / normal.norm()).norm(), 0, 1e-12);
    EXPECT_NEAR(dot(close.right, close.up), 0, 1e-12);
    EXPECT_EQ(close.half_height, 0.25);
  }
}

}  // namespace
}  // namespace triglyph
