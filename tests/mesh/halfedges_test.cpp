#include "engine/mesh/halfedges.h"

#include <gtest/gtest.h>

#include "engine/base/random.h"
#include "tests/support/shapes.h"

namespace triglyph {
namespace {

using OpenMesh::FaceHandle;
using OpenMesh::HalfedgeHandle;
using OpenMesh::VertexHandle;

// What every halfedge kernel must satisfy, whatever mesh it was built from.
void expect_consistent(const Mesh& mesh, const Halfedges& halfedges) {
  const auto& kernel = halfedges.kernel;
  ASSERT_EQ(kernel.n_faces(), mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    auto side = kernel.halfedge_handle(FaceHandle(static_cast<int>(t)));
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(halfedges.point(kernel.from_vertex_handle(side)), mesh.triangles[t][i]);
      EXPECT_EQ(halfedges.point(kernel.to_vertex_handle(side)), mesh.triangles[t][(i + 1) % 3]);
      EXPECT_EQ(kernel.face_handle(side).idx(), static_cast<int>(t));
      side = kernel.next_halfedge_handle(side);
    }
    EXPECT_EQ(side, kernel.halfedge_handle(FaceHandle(static_cast<int>(t))));
  }
  for (std::size_t h = 0; h < kernel.n_halfedges(); ++h) {
    const HalfedgeHandle side(static_cast<int>(h));
    const auto next = kernel.next_halfedge_handle(side);
    ASSERT_TRUE(next.is_valid());
    EXPECT_EQ(kernel.prev_halfedge_handle(next), side);
    EXPECT_EQ(kernel.from_vertex_handle(next), kernel.to_vertex_handle(side));
    EXPECT_EQ(kernel.is_boundary(side), kernel.is_boundary(next));
  }
  std::size_t outgoing = 0;
  for (std::size_t v = 0; v < kernel.n_vertices(); ++v) {
    const VertexHandle vertex(static_cast<int>(v));
    if (kernel.is_isolated(vertex)) continue;
    for (auto it = kernel.cvoh_begin(vertex); it != kernel.cvoh_end(vertex); ++it) ++outgoing;
    if (kernel.is_boundary(vertex)) {
      EXPECT_TRUE(kernel.is_boundary(kernel.halfedge_handle(vertex)));
    }
  }
  EXPECT_EQ(outgoing, kernel.n_halfedges());  // every halfedge lies in exactly one vertex fan
}

TEST(Halfedges, ClosedSurfaceHasNoBoundary) {
  const auto& ball = test::bumpy_ball();
  expect_consistent(ball.mesh, ball.halfedges);
  EXPECT_EQ(ball.halfedges.kernel.n_edges() * 2, ball.mesh.triangles.size() * 3);
  EXPECT_TRUE(ball.halfedges.copied_point.empty());
}

TEST(Halfedges, SheetHasOneBoundaryLoop) {
  const test::Solid sheet(test::flat_grid(5, 3));
  expect_consistent(sheet.mesh, sheet.halfedges);
  std::size_t boundary = 0;
  for (std::size_t h = 0; h < sheet.halfedges.kernel.n_halfedges(); ++h) {
    boundary += sheet.halfedges.kernel.is_boundary(HalfedgeHandle(static_cast<int>(h))) ? 1 : 0;
  }
  EXPECT_EQ(boundary, 2U * (5 + 3));
}

TEST(Halfedges, ThreeFacesOnAnEdgeKeepItOpen) {
  Mesh mesh{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(0, -1, 0)},
            {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}}};
  const test::Solid solid(mesh);
  expect_consistent(solid.mesh, solid.halfedges);
  EXPECT_EQ(solid.halfedges.kernel.n_edges(), 9U);
  EXPECT_EQ(solid.halfedges.copied_point.size(), 4U);  // points 0 and 1, twice each
}

TEST(Halfedges, TwoFansAtAPointBecomeTwoVertices) {
  Mesh mesh{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(-1, 0, 0), Vec3(-1, -1, 0)},
            {{0, 1, 2}, {0, 3, 4}}};
  const test::Solid solid(mesh);
  expect_consistent(solid.mesh, solid.halfedges);
  ASSERT_EQ(solid.halfedges.copied_point.size(), 1U);
  EXPECT_EQ(solid.halfedges.copied_point[0], 0U);
}

TEST(Halfedges, DuplicateAndFlippedFacesAreKept) {
  Mesh mesh = test::tetrahedron();
  mesh.triangles.push_back(mesh.triangles[0]);
  mesh.triangles.push_back({1, 2, 0});
  mesh.positions.emplace_back(9, 9, 9);  // no face uses it
  const test::Solid solid(mesh);
  expect_consistent(solid.mesh, solid.halfedges);
  EXPECT_TRUE(solid.halfedges.kernel.is_isolated(VertexHandle(4)));
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
