#include <cstring>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "tests/io/mesh_text.h"

namespace triglyph {
namespace {

using test::moved;
using test::outcome;
using test::read_text;

const std::string kFacet =
    "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1.5 0 0\nvertex 0 1.5 0\nendloop\n"
    "endfacet\n";

std::string binary(std::uint32_t claimed, std::size_t facets, const std::string& start = "") {
  std::string text = start;
  text.resize(80, ' ');
  text.append(reinterpret_cast<const char*>(&claimed), 4);
  for (std::size_t f = 0; f < facets; ++f) {
    const float values[12] = {0, 0, 1, 0, 0, 0, 1.5F, 0, 0, 0, 1.5F, 0};
    text.append(reinterpret_cast<const char*>(values), sizeof values);
    text.append("\x07\x00", 2);
  }
  return text;
}

TEST(ReadStl, TakesAscii) {
  EXPECT_EQ(read_text("solid a\n" + kFacet + "endsolid a\n", "a.stl").mesh().triangles.size(), 1U);
  EXPECT_EQ(read_text("solid\nendsolid", "a.stl").vertex_count(), 0U);
  const MeshFile two = read_text(
      "SOLID a facet\n" + kFacet + "EndSolid\nsolid b\nendsolid b\nsolid\n" + kFacet + "endsolid",
      "a.stl");
  EXPECT_EQ(two.face_count(), 2U);
  EXPECT_EQ(two.mesh().positions.size(), 3U);
  EXPECT_EQ(two.format(), FileFormat::StlAscii);
  EXPECT_EQ(
      read_text("solid\nfacet normal nan nan nan outer loop vertex 0 0 0 vertex 1 0 0\tvertex 0 "
                "1 0 endloop endfacet\nendsolid",
                "a.stl")
          .face_count(),
      1U);
}

TEST(ReadStl, RefusesBadAscii) {
  EXPECT_EQ(outcome("solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0\nendloop\n", "a.stl"),
            "malformed line 5");
  EXPECT_EQ(outcome("solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 nan\n", "a.stl"),
            "malformed line 4");
  EXPECT_EQ(outcome("solid\n" + kFacet + "junk\nendsolid", "a.stl"), "malformed line 9");
  EXPECT_EQ(outcome("nothing of the kind", "a.stl"), "malformed byte 19");
}

TEST(ReadStl, TakesAsciiAsWritersWriteIt) {
  const std::string apart =
      "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1.5 0 0\nvertex 0 1.5 0\nend loop\n"
      "end facet\n";
  for (const std::string& text :
       {"solid\n" + kFacet, "solid a\n" + kFacet + "end solid a\n", "solid\n" + apart + "endsolid",
        "solid a\n color 0.5 0.5 0.8\n" + kFacet + "endsolid", "solid a\nsolid a\n" + kFacet,
        "solid\r" + kFacet + "\r\nendsolid\r", "solid a\n" + kFacet + "endsolid a\n\n\n"}) {
    const MeshFile file = read_text(text, "a.stl");
    EXPECT_EQ(file.format(), FileFormat::StlAscii) << text;
    EXPECT_EQ(file.face_count(), 1U) << text;
  }
}

// 84 + 50 * n bytes of text are text, although a count of n could be read from them.
TEST(ReadStl, NeverTakesTextForBinary) {
  std::string text = "solid ";
  text.resize(80, 'x');
  const std::uint32_t count = 0x20202020;  // four blanks
  text.append(reinterpret_cast<const char*>(&count), 4);
  text += "\n" + kFacet + "endsolid\n";
  while ((text.size() - 84) % 50 != 0) text += '\n';
  EXPECT_EQ(read_text(text, "a.stl").format(), FileFormat::StlAscii);
}

// Facets behind a count that is too small would stay where they are and tear the surface.
TEST(ReadStl, TakesTheFacetsBehindTheirCount) {
  for (const std::uint32_t claimed : {0U, 1U, 0xffffffffU}) {
    EXPECT_EQ(read_text(binary(claimed, 3), "a.stl").face_count(), 3U) << claimed;
  }
  EXPECT_EQ(read_text(binary(1, 3) + "x", "a.stl").face_count(), 1U);  // not whole facets
  std::string text = binary(1, 2);
  const float infinite = std::numeric_limits<float>::infinity();
  std::memcpy(text.data() + 84 + 50 + 12, &infinite, 4);
  EXPECT_EQ(read_text(text, "a.stl").face_count(), 1U);  // other data
}

TEST(ReadStl, TellsBinaryByStructure) {
  for (const char* start : {"", "solid", "solid x\nfacet normal"}) {
    const MeshFile file = read_text(binary(2, 2, start), "a.stl");
    EXPECT_EQ(file.format(), FileFormat::StlBinary) << start;
    EXPECT_EQ(file.mesh().triangles.size(), 2U);
    EXPECT_EQ(file.mesh().positions.size(), 3U);
  }
  EXPECT_EQ(read_text(binary(0, 0), "a.stl").face_count(), 0U);
}

TEST(ReadStl, KeepsTrailingBytes) {
  const std::string text = binary(1, 1, "solid") + "TRAILER";
  const MeshFile file = read_text(text, "solid.stl");
  EXPECT_EQ(file.face_count(), 1U);
  const std::string out = moved(file, {0.5, 0, 0});
  EXPECT_EQ(out.size(), text.size());
  EXPECT_EQ(out.substr(0, 96), text.substr(0, 96));
  EXPECT_EQ(out.substr(132), text.substr(132));
  EXPECT_EQ(read_text(out, "a.stl").mesh().positions[1], Vec3(2, 0, 0));
}

TEST(ReadStl, RefusesWhatIsCutOff) {
  EXPECT_EQ(outcome(binary(3, 2), "a.stl"), "malformed byte 184");
  EXPECT_EQ(outcome(binary(4000000000U, 1), "trunc.stl"), "malformed byte 134");
  EXPECT_EQ(outcome(binary(0, 0).substr(0, 83), "a.stl"), "malformed byte 83");
}

TEST(ReadStl, RefusesCoordinatesThatAreNotFinite) {
  std::string text = binary(1, 1);
  const float infinite = std::numeric_limits<float>::infinity();
  std::memcpy(text.data() + 84 + 12 + 12 + 4, &infinite, 4);
  EXPECT_EQ(outcome(text, "a.stl"), "malformed byte 112");
}

}  // namespace
}  // namespace triglyph
