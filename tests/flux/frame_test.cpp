#include <gtest/gtest.h>

#include "engine/flux/closed_mesh.h"
#include "engine/flux/functionals.h"
#include "engine/flux/solid_frame.h"
#include "tests/flux/flux_shapes.h"
#include "tests/support/shapes.h"

namespace triglyph {
namespace {

SolidFrame frame_of(const Mesh& mesh) {
  return solid_frame(mesh.positions, mesh.triangles).value();
}

Mesh without_faces_above(Mesh mesh, double height) {
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    return mesh.positions[t[0]][2] > height && mesh.positions[t[1]][2] > height &&
           mesh.positions[t[2]][2] > height;
  });
  return mesh;
}

TEST(ClosedMesh, ClosesEachHoleByAFanAroundItsMiddle) {
  const Mesh open = without_faces_above(test::sphere(24, 2), 1);
  const Halfedges halfedges = build_halfedges(open);
  const ClosedMesh closed({open, halfedges});
  ASSERT_EQ(closed.holes(), 1U);
  const std::vector<Vec3> positions = closed.with_centres(open.positions);
  ASSERT_EQ(positions.size(), open.positions.size() + 1);
  EXPECT_NEAR(positions.back()[0], 0, 1e-9);
  EXPECT_NEAR(positions.back()[1], 0, 1e-9);
  EXPECT_GT(positions.back()[2], 0.9);
  // every edge has its reverse: nothing is open, and no fan is turned over
  std::multiset<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const Triangle& t : closed.triangles()) {
    for (std::size_t c = 0; c < 3; ++c) edges.insert({t[c], t[(c + 1) % 3]});
  }
  for (const auto& [from, to] : edges) {
    EXPECT_EQ(edges.count({from, to}), edges.count({to, from}));
  }
}

// The middle of a hole does not depend on how finely its boundary is divided.
TEST(ClosedMesh, KeepsTheMiddleOfAHoleWhoseBoundaryIsDivided) {
  Mesh open = without_faces_above(test::sphere(24, 2), 1);
  const auto middle = [](const Mesh& mesh, EdgeWeight weight) {
    const Halfedges halfedges = build_halfedges(mesh);
    return ClosedMesh({mesh, halfedges}, weight).with_centres(mesh.positions).back();
  };
  const Vec3 before = middle(open, EdgeWeight::Length);
  EXPECT_LT((middle(open, EdgeWeight::One) - before).norm(), 1e-9);
  // every boundary edge on one side is divided
  const Halfedges halfedges = build_halfedges(open);
  const std::size_t faces = open.triangles.size();
  for (std::uint32_t face = 0; face < faces; ++face) {
    Halfedge side = halfedges.first_of_face(face);
    for (std::size_t i = 0; i < 3; ++i, side = halfedges.next(side)) {
      if (!halfedges.is_boundary(halfedges.opposite(side))) continue;
      const std::uint32_t from = halfedges.from(side), to = halfedges.to(side);
      if (open.positions[from][0] < 0 || open.positions[to][0] < 0) continue;
      const auto added = static_cast<std::uint32_t>(open.positions.size());
      open.positions.push_back((open.positions[from] + open.positions[to]) / 2);
      const std::uint32_t third = halfedges.to(halfedges.next(side));
      open.triangles[face] = {from, added, third};
      open.triangles.push_back({added, to, third});
      break;
    }
  }
  ASSERT_GT(open.triangles.size(), faces);
  EXPECT_LT((middle(open, EdgeWeight::Length) - before).norm(), 1e-9);
  EXPECT_GT((middle(open, EdgeWeight::One) - before).norm(), 0.1);
}

// Loose triangles that hang together by their corners: what fans would enclose is not theirs.
TEST(ClosedMesh, EnclosesNothingIfItsFansAreFarLargerThanItself) {
  const Mesh ball = test::sphere(80, 2);
  const auto frame_of = [](const Mesh& mesh) {
    const Halfedges halfedges = build_halfedges(mesh);
    const ClosedMesh closed({mesh, halfedges});
    return closed.frame(closed.with_centres(mesh.positions));
  };
  EXPECT_TRUE(frame_of(ball));
  EXPECT_TRUE(frame_of(without_faces_above(ball, 0)));
  Mesh strip = without_faces_above(ball, 0.1);  // a band about the middle, open above and below
  std::erase_if(strip.triangles, [&](const Triangle& t) {
    return strip.positions[t[0]][2] < -0.1 || strip.positions[t[1]][2] < -0.1 ||
           strip.positions[t[2]][2] < -0.1;
  });
  ASSERT_FALSE(strip.triangles.empty());
  EXPECT_FALSE(frame_of(strip));
}

TEST(SolidFrame, OfABallHasItsCentreAndRadius) {
  Mesh ball = test::sphere(80, 3);
  for (Vec3& p : ball.positions) p += Vec3(5, 6, 7);
  const SolidFrame frame = frame_of(ball);
  EXPECT_NEAR((frame.centre - Vec3(5, 6, 7)).norm(), 0, 1e-9);
  EXPECT_NEAR(frame.scale, 3 * kFrameScale * std::sqrt(0.6), 0.01);
  EXPECT_EQ(frame.orientation, 1);
}

TEST(SolidFrame, MovesWithTheMesh) {
  const Mesh mesh = test::knobbly(30);
  const SolidFrame before = frame_of(mesh);
  const SolidFrame after = frame_of(test::moved_rigidly(mesh, 2.5));
  EXPECT_NEAR((after.centre - (test::turned(before.centre) * 2.5 + Vec3(3, -2, 5))).norm(), 0,
              1e-9);
  EXPECT_NEAR(after.scale, 2.5 * before.scale, 1e-9);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR((after.axes[axis] - test::turned(before.axes[axis])).norm(), 0, 1e-6) << axis;
    EXPECT_NEAR(after.spreads[axis], 2.5 * before.spreads[axis], 1e-9);
  }
}

TEST(SolidFrame, SeesWhichWayTrianglesTurn) {
  Mesh mesh = test::knobbly(20);
  const SolidFrame before = frame_of(mesh);
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  const SolidFrame after = frame_of(mesh);
  EXPECT_EQ(after.orientation, -before.orientation);
  EXPECT_NEAR((after.centre - before.centre).norm(), 0, 1e-12);
}

TEST(SolidFrame, IsNothingForASheet) {
  const Mesh grid = test::flat_grid(10, 10);
  EXPECT_FALSE(solid_frame(grid.positions, grid.triangles));
}

// Moves each point by a smooth field along its direction.
std::vector<Vec3> pushed(const Mesh& mesh, const std::vector<Vec3>& directions, double size) {
  std::vector<Vec3> positions = mesh.positions;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    positions[i] +=
        size * std::cos(2 * mesh.positions[i][0] + mesh.positions[i][1]) * directions[i];
  }
  return positions;
}

std::vector<Vec3> directions_of(const Mesh& mesh) {
  std::vector<Vec3> directions(mesh.positions.size());
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t point : t) directions[point] += area_normal(mesh.positions, t);
  }
  for (Vec3& direction : directions) direction = direction.normalized();
  return directions;
}

TEST(FrameRows, AreTheFirstOrderChangeOfTheFrame) {
  const Mesh mesh = test::knobbly(60);
  const std::vector<Vec3> directions = directions_of(mesh);
  const SolidFrame frame = frame_of(mesh);
  const auto rows =
      frame_rows(mesh.positions, mesh.triangles, point_faces(mesh), directions, frame);
  const double size = 1e-4;
  const std::vector<Vec3> moved = pushed(mesh, directions, size);
  std::array<double, kFrameRows> sum{};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double move = dot(moved[i] - mesh.positions[i], directions[i]);
    for (std::size_t r = 0; r < kFrameRows; ++r) sum[r] += rows[i][r] * move;
  }
  // The rows are integrals over the surface divided by its area; those over the solid, which give
  // the frame, are the same divided by the volume.
  double area = 0;
  double volume = 0;
  for (const Triangle& t : mesh.triangles) {
    area += triangle_area(mesh.positions, t);
    volume += dot(mesh.positions[t[0]], cross(mesh.positions[t[1]], mesh.positions[t[2]])) / 6;
  }
  const SolidFrame after = solid_frame(moved, mesh.triangles).value();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double shift = dot(after.centre - frame.centre, frame.axes[axis]) / frame.scale;
    EXPECT_NEAR(shift, sum[axis] * area / volume, 2e-3 * size) << axis;
  }
  const double growth = std::pow(after.scale / frame.scale, 2) - 1;
  EXPECT_NEAR(growth / (kFrameScale * kFrameScale), sum[3] * area / volume, 4e-3 * size);
}

TEST(FluxValues, HardlyDependOnTheTriangulation) {
  const Mesh coarse = test::knobbly(40);
  // the same facets, each cut into four
  Mesh fine = coarse;
  fine.triangles.clear();
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
  const auto middle = [&](std::uint32_t a, std::uint32_t b) {
    const auto [at, is_new] = middles.try_emplace(std::minmax(a, b), fine.positions.size());
    if (is_new) fine.positions.push_back((coarse.positions[a] + coarse.positions[b]) / 2);
    return at->second;
  };
  for (const Triangle& t : coarse.triangles) {
    const std::uint32_t a = middle(t[0], t[1]), b = middle(t[1], t[2]), c = middle(t[2], t[0]);
    fine.triangles.insert(fine.triangles.end(),
                          {{t[0], a, c}, {a, t[1], b}, {c, b, t[2]}, {a, b, c}});
  }
  const SolidFrame frame = frame_of(coarse);
  const FluxValues one = flux_values(coarse.positions, coarse.triangles, frame);
  const FluxValues other = flux_values(fine.positions, fine.triangles, frame);
  double largest = 0;
  for (std::size_t i = 0; i < kFunctionals; ++i) {
    largest = std::max(largest, std::abs(one.flux[i]));
    EXPECT_NEAR(one.flux[i], other.flux[i], 2e-5) << i;
    EXPECT_NEAR(one.weight[i], other.weight[i], 2e-4) << i;
  }
  EXPECT_GT(largest, 0.01);
}

TEST(FluxDerivatives, AreTheFirstOrderChangeOfTheFluxes) {
  const Mesh mesh = test::knobbly(50);
  const std::vector<Vec3> directions = directions_of(mesh);
  const SolidFrame frame = frame_of(mesh);
  const FluxDerivatives rows =
      flux_derivatives(mesh.positions, mesh.triangles, point_faces(mesh), directions, frame);
  const double size = 1e-4;
  const std::vector<Vec3> moved = pushed(mesh, directions, size);
  FluxVector predicted{};
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const double move = dot(moved[i] - mesh.positions[i], directions[i]);
    for (const auto& entry : rows.at(i)) predicted[entry.functional] += entry.value * move;
  }
  const FluxValues before = flux_values(mesh.positions, mesh.triangles, frame);
  const FluxValues after = flux_values(moved, mesh.triangles, frame);
  double largest = 0;
  for (std::size_t i = 0; i < kFunctionals; ++i) {
    largest = std::max(largest, std::abs(predicted[i]));
    EXPECT_NEAR(after.flux[i] - before.flux[i], predicted[i], 0.03 * size) << i;
  }
  EXPECT_GT(largest, 0.2 * size);
}

}  // namespace
}  // namespace triglyph
