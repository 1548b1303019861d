#include <string>

#include <gtest/gtest.h>

#include "tests/io/mesh_text.h"

namespace triglyph {
namespace {

using test::moved;
using test::outcome;
using test::read_text;

constexpr const char* kRows = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

TEST(ReadOff, TakesEveryHeader) {
  for (const char* header :
       {"OFF\n3 1 0\n", "OFF 3 1 0\n", "3 1 0\n", "COFF\n3 1 3\n", "NOFF 3 1\n", "STCNOFF\n3 1 0\n",
        "# c\nOFF # d\n\n# e\n3 1 0 # f\n", "OFF#x\n3\n1\n", "OFF3 1 0\n", "COFF3 1 0\n",
        "NCOFF\n3 1 0\n", "CSTNOFF 3 1 0\n", "off\n3 1 0\n", "cnoff3 1 0\n", "stoff\n3\n1\n0\n",
        "OFF\r3 1 0\r", "OFF\r\n3 1 0\r"}) {
    const MeshFile file = read_text(std::string(header) + kRows, "a.off");
    EXPECT_EQ(file.vertex_count(), 3U) << header;
    EXPECT_EQ(file.mesh().triangles.size(), 1U) << header;
  }
}

TEST(ReadOff, RefusesVariantsByName) {
  EXPECT_EQ(outcome(std::string("4OFF\n3 1 0\n") + kRows, "a.off"), "unsupported line 1");
  EXPECT_EQ(outcome(std::string("nOFF\n3 3 1 0\n") + kRows, "a.off"), "unsupported line 1");
  EXPECT_EQ(outcome("OFF BINARY\n....", "a.off"), "unsupported line 1");
  EXPECT_EQ(outcome("OOF\n3 1 0\n", "a.off"), "malformed line 1");
  EXPECT_EQ(outcome("#", "a.off"), "malformed line 1");
}

TEST(ReadOff, TakesRowsOverSeveralLines) {
  const std::string text = "OFF\n3 1 0\n0.5\n0.5 # x\n0.5\n1 0\n0 1 1 1\n0 1 0\n3\n0\n1 2\n";
  const MeshFile file = read_text(text, "a.off");
  EXPECT_EQ(file.mesh().triangles.size(), 1U);
  EXPECT_EQ(moved(file, {0, 0, 0.5}).find("0.5\n0.5 # x\n1\n1 0\n0.5 1 1 1\n"), 10U);
}

TEST(ReadOff, KeepsWhatFollowsTheCoordinates) {
  const std::string text =
      "COFF\n3 2 0\n0.5 0.5 0.25 1 0 0 1 # red\n\n1.25 0.00 0.00 1 0 0 1\n0 1 0\n# faces\n"
      "3 0 1 2 255 0 0\n3 2 1 0 7\n";
  const MeshFile file = read_text(text, "a.off");
  EXPECT_EQ(file.face_count(), 2U);
  EXPECT_EQ(
      moved(file, {0.25, 0, 0}),
      "COFF\n3 2 0\n0.75 0.5 0.25 1 0 0 1 # red\n\n1.50 0.00 0.00 1 0 0 1\n0.25 1 0\n# faces\n"
      "3 0 1 2 255 0 0\n3 2 1 0 7\n");
}

TEST(ReadOff, RefusesBadRowsAtTheirLine) {
  EXPECT_EQ(outcome("OFF\n3 1 0\n0 0 0\n1 0\n0 1 0\n3 0 1 2\n", "a.off"), "malformed line 7");
  EXPECT_EQ(outcome("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", "a.off"), "malformed line 6");
  EXPECT_EQ(outcome("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1\n", "a.off"), "malformed line 7");
  EXPECT_EQ(outcome("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 -1 2\n", "a.off"), "malformed line 6");
  EXPECT_EQ(outcome("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n", "a.off"), "malformed line 6");
  EXPECT_EQ(outcome("OFF\n-3 1 0\n", "a.off"), "malformed line 2");
  EXPECT_EQ(outcome("OFF\nx 1 0\n", "a.off"), "malformed line 2");
  EXPECT_EQ(outcome("OFF\n99999999999999999999 1 0\n", "a.off"), "malformed line 2");
  EXPECT_EQ(outcome("OFF\n4000000000 4000000000 0\n0 0 0\n", "huge.off"), "malformed line 4");
  EXPECT_EQ(outcome("OFF\n1 1 0\n0 0 0\n4000000000 0 0 0\n", "a.off"), "malformed line 5");
}

TEST(ReadOff, TakesFacesWithoutArea) {
  const MeshFile file = read_text("OFF\n2 3 0\n0 0 0\n1 0 0\n2 0 1\n0\n3 0 1 1\n", "a.off");
  EXPECT_EQ(file.face_count(), 3U);
  EXPECT_TRUE(file.mesh().triangles.empty());
}

}  // namespace
}  // namespace triglyph
