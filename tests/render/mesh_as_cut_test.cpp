#include "render/mesh_as_cut.h"

#include <string>

#include <gtest/gtest.h>

namespace triglyph {
namespace {

MeshFile quad(const std::string& first, const std::string& face = "f 1 2 3 4\n") {
  const std::string text = first + "v 1 0 0\nv 1 1 0\nv 0 1 0\n" + face;
  return MeshFile::read({text.begin(), text.end()}, "a.obj");
}

// The move makes the other diagonal the shorter one.
TEST(MeshAsCut, HasTheTrianglesOfTheOriginal) {
  const MeshFile before = quad("v -0.01 0 0\n"), after = quad("v 0.01 0 0\n");
  ASSERT_NE(before.mesh().triangles, after.mesh().triangles);
  const Mesh mesh = mesh_as_cut_in(before, after);
  EXPECT_EQ(mesh.triangles, before.mesh().triangles);
  EXPECT_EQ(mesh.positions, after.mesh().positions);
}

TEST(MeshAsCut, LeavesOtherPolygonsAsTheyAre) {
  const MeshFile before = quad("v -0.01 0 0\n");
  for (const char* face : {"f 1 2 4\nf 2 3 4\n", "f 4 3 2 1\n"}) {
    const MeshFile other = quad("v 0.01 0 0\n", face);
    EXPECT_EQ(mesh_as_cut_in(before, other).triangles, other.mesh().triangles) << face;
  }
}

}  // namespace
}  // namespace triglyph
