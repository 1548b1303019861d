// Agreement with an independent implementation of the same distance.
#include "tests/support/cgal_hausdorff.h"

#include <utility>

#include <gtest/gtest.h>

#include "engine/base/random.h"
#include "engine/metric/hausdorff.h"
#include "tests/support/remeshing.h"
#include "tests/support/shapes.h"

namespace triglyph {
namespace {

constexpr double kOurTolerance = 1e-7;

TEST(Hausdorff, AgreesWithCgal) {
  const Mesh& ball = test::bumpy_ball().mesh;
  Mesh moved = ball;
  for (std::size_t i = 0; i < moved.positions.size(); i += 3) {
    moved.positions[i] += 0.02 * Vec3(random_unit(13, 0, i) - 0.5, random_unit(13, 1, i) - 0.5,
                                      random_unit(13, 2, i) - 0.5);
  }
  const Mesh coarse = test::decimated(ball, 0.7);
  const Mesh other = make_sample_shape(SampleShape::HighGenus, 3000, 5);
  for (const Mesh* second : {&std::as_const(moved), &coarse, &other}) {
    const HausdorffDistance ours = hausdorff(ball, *second, kOurTolerance);
    EXPECT_LE(ours.forward.error, kOurTolerance);
    EXPECT_LE(ours.backward.error, kOurTolerance);
    const double cgal = test::cgal_hausdorff(ball, *second, 1e-5);
    EXPECT_NEAR(cgal, ours.symmetric(), 1e-5);
    EXPECT_LE(cgal, ours.symmetric() + ours.error() + 1e-9);
  }
}

}  // namespace
}  // namespace triglyph
