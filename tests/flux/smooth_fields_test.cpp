#include <gtest/gtest.h>

#include "engine/flux/curvature_flow.h"
#include "engine/flux/thin_plate.h"
#include "engine/mesh/edge_graph.h"
#include "engine/mesh/uniform_flow.h"
#include "tests/flux/flux_shapes.h"

namespace triglyph {
namespace {

double largest_distance(std::span<const Vec3> a, std::span<const Vec3> b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, (a[i] - b[i]).norm());
  return largest;
}

TEST(UniformFlow, MovesPointsTowardsTheMeanOfTheirNeighbours) {
  const Mesh mesh = test::shaken(test::knobbly(12), 0.05, 1);
  const EdgeGraph graph = edge_graph(mesh);
  const std::vector<Vec3> smooth = UniformFlow(mesh).smoothed(mesh.positions, 1);
  for (std::uint32_t point = 0; point < mesh.positions.size(); ++point) {
    Vec3 mean;
    for (const auto& spoke : graph.around(point)) mean += mesh.positions[spoke.to];
    mean /= static_cast<double>(graph.around(point).size());
    const Vec3 expected = mesh.positions[point] + kFlowStep * (mean - mesh.positions[point]);
    EXPECT_NEAR((smooth[point] - expected).norm(), 0, 1e-12);
  }
}

TEST(UniformFlow, IsUndone) {
  const Mesh mesh = test::knobbly(40);
  const UniformFlow flow(mesh);
  const std::vector<Vec3> smooth = flow.smoothed(mesh.positions, 30);
  const double moved = largest_distance(smooth, mesh.positions);
  EXPECT_LT(largest_distance(flow.unsmoothed(smooth, 30, 20), mesh.positions), 0.05 * moved);
}

TEST(CurvatureFlow, ShrinksABallByTheTimeOverItsRadius) {
  const Mesh ball = test::sphere(40, 2);
  const double time = 1e-3;
  const std::vector<Vec3> after = curvature_flowed(ball, time);
  // the mean curvature vector of a ball has length 2 / radius
  for (std::size_t i = 0; i < after.size(); ++i) {
    if (std::abs(ball.positions[i][2]) > 1.8) continue;  // poles have slivers
    EXPECT_NEAR((2 - after[i].norm()) / time, 1, 0.1) << i;
  }
}

// One functional: the value of the field at a point.
ThinPlate::Row value_at(std::size_t wanted) {
  return [wanted](std::size_t point, const std::function<void(std::size_t, double)>& add) {
    if (point == wanted) add(0, 1);
  };
}

// The field of least energy whose value at a point is 1.
std::vector<double> bump(const ThinPlate& plate, std::size_t point) {
  const Columns fields = plate.solved(plate.restricted(1, value_at(point)));
  std::vector<double> field = plate.field(fields.column(0));
  const double height = field[point];
  for (double& value : field) value /= height;
  return field;
}

TEST(ThinPlate, FieldsAreSmoothAndFadeAtTheirLength) {
  const Mesh mesh = test::knobbly(50);
  const ThinPlate plate(mesh, 0.15);
  ASSERT_EQ(plate.unknowns(), mesh.positions.size());
  constexpr std::size_t kPoint = 2500;
  const std::vector<double> field = bump(plate, kPoint);
  const EdgeGraph graph = edge_graph(mesh);
  for (const auto& spoke : graph.around(kPoint)) EXPECT_GT(field[spoke.to], 0.7);
  for (std::size_t i = 0; i < field.size(); ++i) {
    if ((mesh.positions[i] - mesh.positions[kPoint]).norm() > 1.5) {
      EXPECT_LT(std::abs(field[i]), 0.01) << i;
    }
  }
}

TEST(ThinPlate, OfAFineMeshIsNearlyThatOfItsPoints) {
  // just above and just below the size from which a subspace takes the place of the points
  const Mesh fine = test::knobbly(84);
  const Mesh coarse = test::knobbly(70);
  const ThinPlate subspace(fine, 0.15);
  const ThinPlate exact(coarse, 0.15);
  ASSERT_LT(subspace.unknowns(), fine.positions.size() / 4);
  ASSERT_EQ(exact.unknowns(), coarse.positions.size());
  const std::size_t fine_point = 1 + 41 * 168;  // on the equator of each
  const std::size_t coarse_point = 1 + 34 * 140;
  const std::vector<double> fine_field = bump(subspace, fine_point);
  const std::vector<double> coarse_field = bump(exact, coarse_point);
  // along the equator
  for (std::size_t share = 0; share < 5; ++share) {
    EXPECT_NEAR(fine_field[fine_point + 6 * share], coarse_field[coarse_point + 5 * share], 0.08)
        << share;
  }
}

}  // namespace
}  // namespace triglyph
