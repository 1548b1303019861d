// Measures of what people see: curvature, structural distortion, roughness.
#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "engine/metric/comparison.h"
#include "engine/metric/curvature.h"
#include "engine/metric/roughness.h"
#include "engine/metric/structural_distortion.h"
#include "tests/support/arenas.h"
#include "tests/support/motions.h"
#include "tests/support/remeshing.h"
#include "tests/support/shapes.h"

namespace triglyph {
namespace {

TEST(EdgeGraph, KnowsInnerAndBoundaryEdges) {
  const Mesh sheet = test::flat_grid(2, 1);
  const EdgeGraph graph = edge_graph(sheet);
  EXPECT_EQ(graph.edges.size(), 9U);
  EXPECT_EQ(std::count_if(graph.edges.begin(), graph.edges.end(),
                          [](const Edge& edge) { return edge.is_inner(); }),
            3);
  for (const Edge& edge : graph.edges) {
    if (!edge.is_inner()) continue;
    const Triangle& along = sheet.triangles[edge.faces[0]];
    const auto at = std::find(along.begin(), along.end(), edge.from) - along.begin();
    EXPECT_EQ(along[static_cast<std::size_t>(at + 1) % 3], edge.to);
  }
  std::size_t spokes = 0;
  for (std::uint32_t p = 0; p < sheet.positions.size(); ++p) spokes += graph.around(p).size();
  EXPECT_EQ(spokes, 18U);
}

TEST(MeanCurvatures, OfASphereAreOneOverItsRadius) {
  const Mesh globe = test::sphere(80, 2);
  const std::vector<double> curvatures = mean_curvatures(globe, edge_graph(globe), 0.5);
  for (std::size_t p = 1 + 40 * 160; p < 1 + 41 * 160; ++p) EXPECT_NEAR(curvatures[p], 0.5, 0.02);
}

TEST(MeanCurvatures, OfATubeAreHalfOfThat) {
  const Mesh pipe = test::tube(160, 40, 2, 3);
  const std::vector<double> curvatures = mean_curvatures(pipe, edge_graph(pipe), 0.5);
  for (std::size_t p = 20 * 160; p < 21 * 160; ++p) EXPECT_NEAR(curvatures[p], 0.25, 0.01);
}

TEST(MeanCurvatures, OfAPlaneAreNothing) {
  const Mesh sheet = test::flat_grid(5, 5);
  for (const double curvature : mean_curvatures(sheet, edge_graph(sheet), 1.5)) {
    EXPECT_NEAR(curvature, 0, 1e-12);
  }
}

TEST(StructuralDistortion, OfEqualSurfacesIsNothing) {
  const Mesh& ball = test::bumpy_ball().mesh;
  EXPECT_LT(msdm(ball, ball), 1e-12);
  EXPECT_LT(msdm2(ball, ball), 1e-6);
}

TEST(StructuralDistortion, GrowsWithNoiseAndStaysBelowOne) {
  const Mesh& ball = test::bumpy_ball().mesh;
  double last = 0, last2 = 0;
  for (const double noise : {0.0005, 0.002, 0.008}) {
    const Mesh other = test::shaken(ball, noise, 3);
    const double now = msdm(ball, other);
    const double now2 = msdm2(ball, other);
    EXPECT_GT(now, last);
    EXPECT_GT(now2, last2);
    EXPECT_LT(now, 1);
    EXPECT_LT(now2, 1);
    last = now;
    last2 = now2;
  }
  EXPECT_GT(last2, 0.2);
}

TEST(StructuralDistortion, DoesNotDependOnPlaceTurnAndScaleNorOnOrder) {
  const Mesh globe = test::sphere(30, 1);
  const Mesh other = test::shaken(globe, 0.01, 3);
  EXPECT_NEAR(msdm(globe, other), msdm(other, globe), 0.02);
  EXPECT_EQ(msdm2(globe, other), msdm2(other, globe));
  // a globe's box is as long after a turn by a right angle about an axis
  const auto quarter = [](Mesh mesh) {
    for (Vec3& p : mesh.positions) p = Vec3(-p[1], p[0], p[2]) * 4 + Vec3(1, 2, 3);
    return mesh;
  };
  EXPECT_NEAR(msdm(quarter(globe), quarter(other)), msdm(globe, other), 1e-6);
  EXPECT_NEAR(msdm2(quarter(globe), quarter(other)), msdm2(globe, other), 1e-6);
}

// Masking: the same noise is seen less where the surface is rough already.
TEST(StructuralDistortion, OfNoiseIsLessOnARoughSurface) {
  const Mesh smooth = test::sphere(60, 1);
  const Mesh rough = test::shaken(smooth, 0.02, 5);
  EXPECT_LT(msdm2(rough, test::shaken(rough, 0.003, 6)),
            0.7 * msdm2(smooth, test::shaken(smooth, 0.003, 6)));
}

TEST(StructuralDistortion, ComparesTessellations) {
  const Mesh& ball = test::bumpy_ball().mesh;
  const double near = msdm2(ball, test::decimated(ball, 0.2));
  const double far = msdm2(ball, test::decimated(ball, 0.9));
  EXPECT_GT(near, 0);
  EXPECT_LT(near, far);
}

TEST(StructuralDistortion, DoesNotDependOnThreads) {
  const Mesh& ball = test::bumpy_ball().mesh;
  const Mesh other = test::shaken(ball, 0.002, 3);
  test::expect_same_for_any_threads(
      [&] { return std::pair(msdm(ball, other), msdm2(ball, other)); });
}

TEST(Roughness, IsNothingOnAPlaneAndGrowsWithNoise) {
  EXPECT_NEAR(roughness(test::flat_grid(9, 9)), 0, 1e-12);
  const Mesh globe = test::sphere(40, 1);
  const double smooth = roughness(globe);
  const double shaken = roughness(test::shaken(globe, 0.005, 1));
  const double more = roughness(test::shaken(globe, 0.01, 1));
  EXPECT_LT(smooth, shaken);
  EXPECT_LT(shaken, more);
  EXPECT_NEAR(roughness(test::moved_rigidly(globe, 3)), smooth, 1e-9 * smooth + 1e-12);
  EXPECT_GT(roughness_increase(smooth, more), roughness_increase(smooth, shaken));
  EXPECT_EQ(roughness_increase(smooth, smooth), 0);
  EXPECT_LT(roughness_increase(more, smooth), 0);
}

TEST(Compare, KnowsEveryMetricByName) {
  const Mesh& ball = test::bumpy_ball().mesh;
  const Mesh other = test::shaken(ball, 0.002, 3);
  for (const std::string_view name : metric_names()) {
    const auto values = compare(ball, other, name);
    ASSERT_FALSE(values.empty()) << name;
    for (const NamedValue& value : values) EXPECT_TRUE(std::isfinite(value.value)) << value.name;
  }
  EXPECT_THROW((void)compare(ball, other, "beauty"), Error);
}

TEST(Compare, RefusesWhatTwoMeshesDoNotHave) {
  const Mesh& ball = test::bumpy_ball().mesh;
  const Mesh coarse = test::decimated(ball, 0.5);
  for (const std::string_view name : metric_names()) {
    EXPECT_THROW((void)compare(ball, {}, name), Error);
    if (needs_same_triangles(name)) {
      EXPECT_THROW((void)compare(ball, coarse, name), Error);
    } else {
      EXPECT_FALSE(compare(ball, coarse, name).empty());
    }
  }
}

TEST(StructuralDistortion, FewWindowsStandForAll) {
  const Mesh ball = test::bumpy_ball().mesh;
  const Mesh other = test::shaken(ball, 0.002, 3);
  const double all = msdm2(ball, other);
  EXPECT_EQ(msdm2(ball, other, ball.positions.size()), all);
  const double some = msdm2(ball, other, ball.positions.size() / 7);
  EXPECT_NE(some, all);
  EXPECT_NEAR(some, all, 0.1 * all);
}

}  // namespace
}  // namespace triglyph
