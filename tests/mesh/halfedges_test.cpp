#include "engine/mesh/halfedges.h"

#include <gtest/gtest.h>

#include "engine/base/random.h"
#include "tests/support/shapes.h"

namespace triglyph {
namespace {

// What every halfedge structure must satisfy, whatever mesh it was built from.
void expect_consistent(const Mesh& mesh, const Halfedges& halfedges) {
  ASSERT_EQ(halfedges.face_count(), mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    Halfedge side = halfedges.first_of_face(t);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(halfedges.from(side), mesh.triangles[t][i]);
      EXPECT_EQ(halfedges.to(side), mesh.triangles[t][(i + 1) % 3]);
      EXPECT_EQ(halfedges.face(side), t);
      side = halfedges.next(side);
    }
    EXPECT_EQ(side, halfedges.first_of_face(t));
  }
  for (std::uint32_t h = 0; h < 2 * halfedges.edge_count(); ++h) {
    const Halfedge side = halfedges.of_edge(h / 2, h % 2);
    EXPECT_EQ(halfedges.edge(side), h / 2);
    EXPECT_EQ(halfedges.edge(halfedges.opposite(side)), h / 2);
    EXPECT_EQ(halfedges.opposite(halfedges.opposite(side)), side);
    const Halfedge next = halfedges.next(side);
    ASSERT_NE(next, kNoHalfedge);
    EXPECT_EQ(halfedges.previous(next), side);
    EXPECT_EQ(halfedges.to_vertex(halfedges.opposite(next)), halfedges.to_vertex(side));
    EXPECT_EQ(halfedges.is_boundary(side), halfedges.is_boundary(next));
  }
  std::size_t outgoing = 0;
  for (std::uint32_t vertex = 0; vertex < halfedges.vertex_count(); ++vertex) {
    const Halfedge first = halfedges.outgoing(vertex);
    if (first == kNoHalfedge) continue;
    bool at_boundary = false;
    Halfedge spoke = first;
    do {
      ++outgoing;
      at_boundary = at_boundary || halfedges.is_boundary(spoke);
      EXPECT_EQ(halfedges.to_vertex(halfedges.opposite(spoke)), vertex);
      spoke = halfedges.turned(spoke);
    } while (spoke != first);
    EXPECT_EQ(at_boundary, halfedges.is_boundary(first));
  }
  // every halfedge lies in exactly one vertex fan
  EXPECT_EQ(outgoing, 2 * std::size_t{halfedges.edge_count()});
}

TEST(Halfedges, ClosedSurfaceHasNoBoundary) {
  const auto& ball = test::bumpy_ball();
  expect_consistent(ball.mesh, ball.halfedges);
  EXPECT_EQ(ball.halfedges.edge_count() * 2, ball.mesh.triangles.size() * 3);
  EXPECT_TRUE(ball.halfedges.copied_points().empty());
}

TEST(Halfedges, SheetHasOneBoundaryLoop) {
  const test::Solid sheet(test::flat_grid(5, 3));
  expect_consistent(sheet.mesh, sheet.halfedges);
  std::size_t boundary = 0;
  for (std::uint32_t h = 0; h < 2 * sheet.halfedges.edge_count(); ++h) {
    boundary += sheet.halfedges.is_boundary(sheet.halfedges.of_edge(h / 2, h % 2)) ? 1 : 0;
  }
  EXPECT_EQ(boundary, 2U * (5 + 3));
}

TEST(Halfedges, ThreeFacesOnAnEdgeKeepItOpen) {
  Mesh mesh{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(0, -1, 0)},
            {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}}};
  const test::Solid solid(mesh);
  expect_consistent(solid.mesh, solid.halfedges);
  EXPECT_EQ(solid.halfedges.edge_count(), 9U);
  EXPECT_EQ(solid.halfedges.copied_points().size(), 4U);  // points 0 and 1, twice each
}

TEST(Halfedges, TwoFansAtAPointBecomeTwoVertices) {
  Mesh mesh{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(-1, 0, 0), Vec3(-1, -1, 0)},
            {{0, 1, 2}, {0, 3, 4}}};
  const test::Solid solid(mesh);
  expect_consistent(solid.mesh, solid.halfedges);
  ASSERT_EQ(solid.halfedges.copied_points().size(), 1U);
  EXPECT_EQ(solid.halfedges.copied_points()[0], 0U);
}

TEST(Halfedges, DuplicateAndFlippedFacesAreKept) {
  Mesh mesh = test::tetrahedron();
  mesh.triangles.push_back(mesh.triangles[0]);
  mesh.triangles.push_back({1, 2, 0});
  mesh.positions.emplace_back(9, 9, 9);  // no face uses it
  const test::Solid solid(mesh);
  expect_consistent(solid.mesh, solid.halfedges);
  EXPECT_EQ(solid.halfedges.outgoing(4), kNoHalfedge);
}

TEST(Halfedges, SurfacesOfAnyKindAreConsistent) {
  expect_consistent(Mesh{}, build_halfedges(Mesh{}));
  for (const SampleShape shape : {SampleShape::Open, SampleShape::HighGenus}) {
    const test::Solid solid(make_sample_shape(shape, 3000, 5));
    expect_consistent(solid.mesh, solid.halfedges);
  }
  // a soup in which most edges and points are not manifold
  Mesh soup;
  for (std::uint32_t i = 0; i < 12; ++i) soup.positions.emplace_back(i, i * i % 7, i * 5 % 11);
  for (std::uint64_t t = 0; t < 100; ++t) {
    const auto draw = [&](std::uint64_t k) {
      return static_cast<std::uint32_t>(random_bits(3, t, k) % 12);
    };
    const Triangle triangle{draw(0), draw(1), draw(2)};
    if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]) {
      continue;
    }
    soup.triangles.push_back(triangle);
  }
  const test::Solid solid(soup);
  expect_consistent(solid.mesh, solid.halfedges);
}

}  // namespace
}  // namespace triglyph
