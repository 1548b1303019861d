#include <string>

#include <gtest/gtest.h>

#include "tests/io/mesh_text.h"

namespace triglyph {
namespace {

using test::moved;
using test::outcome;
using test::read_text;

constexpr const char* kThree = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

std::string with_face(const std::string& face) {
  return kThree + face + "\n";
}

TEST(ReadObj, TakesEveryFormOfACorner) {
  for (const char* face :
       {"f 1 2 3", "f 1/7 2/8 3/9", "f 1//4 2//5 3//6", "f 1/1/1 2/2/2 3/3/3", "f -3 -2 -1",
        "f -3/-1 +2 3/", "  f\t1 2 3  ", "f 1 2 3 # 4 5", "f 1 2 \\\n 3", "f 1 2 3\\\n"}) {
    const MeshFile file = read_text(with_face(face), "a.obj");
    ASSERT_EQ(file.mesh().triangles.size(), 1U) << face;
    EXPECT_EQ(file.mesh().triangles[0], (Triangle{0, 1, 2})) << face;
  }
}

TEST(ReadObj, TakesFacesBeforeTheirVertices) {
  EXPECT_EQ(read_text(std::string("f 1 2 3\n") + kThree, "a.obj").mesh().triangles.size(), 1U);
  EXPECT_EQ(outcome(std::string("\nf 1 2 4\n") + kThree, "a.obj"), "malformed line 2");
  EXPECT_EQ(outcome("v 0 0 0\nf -1 -2 1\n", "a.obj"), "malformed line 2");
}

TEST(ReadObj, RefusesBadFacesAtTheirLine) {
  for (const char* face :
       {"f", "f 0 1 2", "f /1 2 3", "f 1 2 99", "f 1 2 -4", "f 1 2 x", "f 1 2 3x", "f 1/2/3/4 2 3",
        "f 1.5 2 3", "f 1 2 99999999999999999999", "f 1 2 \\3"}) {
    EXPECT_EQ(outcome(with_face(face), "a.obj"), "malformed line 4") << face;
  }
}

TEST(ReadObj, RefusesBadVertices) {
  for (const char* line : {"v", "v 1", "v 1 2", "v 1 x 0", "v nan 0 0", "v 0 inf 0", "v 1e999 0 0",
                           "v 1,5 0 0", "v 1 2 3x"}) {
    EXPECT_EQ(outcome(std::string("# c\n") + line + "\nv 1 2 3\n", "a.obj"), "malformed line 2")
        << line;
  }
  EXPECT_EQ(outcome("# nothing\n", "a.obj"), "malformed line 2");
}

TEST(ReadObj, PassesOverEverythingElse) {
  const MeshFile file = read_text(
      "mtllib ../../../dev/zero\n# v 9 9 9 C:\\\nv 0 0 0 1.0 0.5 0.5\nvt 0 0\nvn 0 0 1\nvp 1\n"
      "o x\ng y\ns off\nusemtl z\nl 1 2 \\\nv 8 8 8\nv 1 0 0#c\n\nv 0 1 0 # d\\\nfo 1\ncurv 0 1 "
      "2\nf 1 2 3",
      "a.obj");
  EXPECT_EQ(file.vertex_count(), 3U);
  EXPECT_EQ(file.face_count(), 1U);
}

TEST(ReadObj, TakesEveryLineEnd) {
  EXPECT_EQ(read_text("v 0 0 0\r\nv 1 0 \\\r\n 0\r\nv 0 1 0\r\nf 1 2 3\r\n", "a.obj").face_count(),
            1U);
  EXPECT_EQ(read_text("# c\rv 0 0 0\rv 1 0 \\\r 0\rv 0 1 0\rf 1 2 3", "a.obj").face_count(), 1U);
  EXPECT_EQ(outcome("v 0 0 0\rv 0 0\r", "a.obj"), "malformed line 2");
}

TEST(ReadObj, TakesLineEndsOfEveryKindInOneFile) {
  const std::string text = "v 0 0 0\rv 1 0 0\r\nv 0 1 0\n\r\rf 1 2 \\\r 3\rf 1 2 3 \\\r\n\n";
  const MeshFile file = read_text(text, "a.obj");
  EXPECT_EQ(file.vertex_count(), 3U);
  EXPECT_EQ(file.face_count(), 2U);
  EXPECT_EQ(moved(file, {0, 0, 1}),
            "v 0 0 1\rv 1 0 1\r\nv 0 1 1\n\r\rf 1 2 \\\r 3\rf 1 2 3 \\\r\n\n");
  EXPECT_EQ(outcome("v 0 0 0\rv 1 0 0\r\nv 0 1\n", "a.obj"), "malformed line 3");
}

TEST(ReadObj, PassesOverPointsAndLinesAmongTheFaces) {
  const MeshFile file =
      read_text(std::string(kThree) + "f 1\nf 1 2\nf 1/1 3/2 # c\nf 1 2 3\n", "a.obj");
  EXPECT_EQ(file.face_count(), 1U);
  EXPECT_EQ(file.mesh().triangles.size(), 1U);
  EXPECT_EQ(outcome(std::string(kThree) + "f 1 9\n", "a.obj"), "malformed line 4");
}

TEST(ReadObj, SkipsAByteOrderMarkButNotUtf16) {
  EXPECT_EQ(read_text("\xEF\xBB\xBFv 0 0 0\n", "a.obj").vertex_count(), 1U);
  EXPECT_EQ(outcome(std::string("\xFF\xFEv\0 \0", 6), "a.obj"), "unsupported byte 0");
  EXPECT_EQ(outcome(std::string("\xFE\xFF\0v\0 ", 6), "a.obj"), "unsupported byte 0");
}

TEST(ReadObj, IsPatchedInCoordinatesAlone) {
  const std::string text =
      "mtllib a.mtl\r\n  v\t0.500 -0.250\\\r\n 1.125 1.0 # w\r\nv 2.000 0.000 0.000 255 0 0\r\n"
      "v 0 1 0\r\nf 1/1 2/2 3/3\r\n";
  const std::string expected =
      "mtllib a.mtl\r\n  v\t0.510 -0.250\\\r\n 1.125 1.0 # w\r\nv 2.010 0.000 0.000 255 0 0\r\n"
      "v 0.010 1 0\r\nf 1/1 2/2 3/3\r\n";
  EXPECT_EQ(moved(read_text(text, "a.obj"), {0.01, 0, 0.0001}), expected);
}

TEST(ReadObj, KeepsMinusZeroOfPointsThatStay) {
  const MeshFile file = read_text("v -0.00 1.25 0.00\nv 0.00 1.25 -0.00\n", "a.obj");
  EXPECT_EQ(file.mesh().positions.size(), 1U);
  EXPECT_EQ(moved(file, {0, 0, 0}), "v -0.00 1.25 0.00\nv 0.00 1.25 -0.00\n");
  EXPECT_EQ(moved(file, {0, 0.5, 0}), "v -0.00 1.75 0.00\nv 0.00 1.75 -0.00\n");
  EXPECT_EQ(moved(file, {-0.001, -1.2501, 0}), "v -0.00 0.00 0.00\nv 0.00 0.00 -0.00\n");
}

// Files that broke other readers.
TEST(ReadObj, HoldsAgainstHostileFiles) {
  EXPECT_EQ(outcome("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 99\nf 0 1 2\nf /1 2 3\nf 1 2 3 1\nf 1 2 3\n",
                    "badf.obj"),
            "malformed line 5");
  EXPECT_EQ(outcome("v 0 0 0\nv 1 x 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "badv.obj"),
            "malformed line 2");
  EXPECT_EQ(outcome("v 0.5 0.25 0\nv 1.5 0 0\nv 0 1.5 0\nf 1 2 3\n", "loc.obj"), "read");
  EXPECT_EQ(outcome("mtllib ../../../../../../../dev/zero\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
                    "mtl.obj"),
            "read");
  EXPECT_EQ(outcome("v nan inf 0\nv 1e999 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "nan.obj"),
            "malformed line 1");
  EXPECT_EQ(outcome("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 -1 0\nf 1 2 3\nf 1 2 4\nf 1 2 5\n",
                    "nm.obj"),
            "read");
  EXPECT_EQ(outcome("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\nf 90000000/1/1 2/1/1 3/1/1\n",
                    "oob.obj"),
            "malformed line 6");
  EXPECT_EQ(outcome("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0.5 0.5\nf 5000/1 2/1 3/1\n", "oob2.obj"),
            "malformed line 5");
  const MeshFile tiny = read_text("v 1e-7 2e-7 3e-7\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "tiny.obj");
  EXPECT_EQ(tiny.mesh().positions[0], Vec3(1e-7, 2e-7, 3e-7));
}

}  // namespace
}  // namespace triglyph
