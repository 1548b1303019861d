#include <string>

#include <gtest/gtest.h>

#include "tests/io/mesh_text.h"

namespace triglyph {
namespace {

using test::moved;
using test::outcome;
using test::read_text;

const std::string kVertex =
    "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
const std::string kFace = "element face 1\nproperty list uchar int vertex_indices\n";

std::string ascii(const std::string& elements, const std::string& rows) {
  return "ply\nformat ascii 1.0\n" + elements + "end_header\n" + rows;
}

TEST(ReadPly, TakesAscii) {
  const MeshFile file =
      read_text(ascii(kVertex + kFace, "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"), "a.ply");
  EXPECT_EQ(file.format(), FileFormat::PlyAscii);
  EXPECT_EQ(file.mesh().triangles.size(), 1U);
}

TEST(ReadPly, TakesAnyOrderOfElementsAndProperties) {
  const MeshFile file = read_text(
      ascii("comment c\nelement face 1\nproperty uchar k\nproperty list uint int8 vertex_index\n"
            "obj_info x\nelement vertex 3\nproperty double z\nproperty list uchar float w\n"
            "property int x\nproperty uchar red\nproperty float32 y\n",
            "9 3 0 1 2\n0.25 2 1 1 10 255 0.5\n0 0 20 0 0\n0 1 5 30 0 0\n"),
      "a.ply");
  EXPECT_EQ(file.mesh().positions[0], Vec3(10, 0.5, 0.25));
  EXPECT_EQ(file.round({1.4, 0.54, 0.3}), Vec3(1, 0.54, 0.3));
  const std::string out = moved(file, {1.6, 0.25, 0.5});
  EXPECT_EQ(out.substr(out.find("end_header")),
            "end_header\n9 3 0 1 2\n0.75 2 1 1 12 255 0.75\n0.5 0 22 0 0.25\n0.5 1 5 32 0 0.25\n");
}

TEST(ReadPly, ReadsStrips) {
  const MeshFile file =
      read_text(ascii("element vertex 5\nproperty float x\nproperty float y\nproperty float z\n"
                      "element tristrips 1\nproperty list int int vertex_indices\n",
                      "0 0 0\n1 0 0\n0 1 0\n1 1 0\n2 2 0\n9 0 1 2 3 -1 2 3 4 -1\n"),
                "a.ply");
  EXPECT_EQ(file.face_count(), 3U);
  EXPECT_EQ(file.mesh().triangles, (std::vector<Triangle>{{0, 1, 2}, {2, 1, 3}, {2, 3, 4}}));
}

TEST(ReadPly, StartsThePayloadBehindTheLineFeed) {
  // A payload that starts with bytes that look like line ends.
  std::string text =
      "ply\r\nformat binary_big_endian 1.0\r\nelement vertex 1\r\nproperty uchar x\r\n"
      "property short y\r\nproperty float z\r\nend_header\r\n";
  text += std::string("\x0a\x0d\x0a\x3f\x80\x00\x00", 7);
  const MeshFile file = read_text(text, "a.ply");
  EXPECT_EQ(file.mesh().positions[0], Vec3(10, 0x0d0a, 1));
  const std::string out = moved(file, {300, -100000, 0.5});
  EXPECT_EQ(out.substr(out.size() - 7), std::string("\xff\x80\x00\x3f\xc0\x00\x00", 7));
}

TEST(ReadPly, RefusesBadHeadersAtTheirLine) {
  EXPECT_EQ(outcome("plY\n", "a.ply"), "malformed line 1");
  EXPECT_EQ(outcome("ply\nformat ascii 1.0\nproperty float x\nend_header\n", "noelem.ply"),
            "malformed line 3");
  EXPECT_EQ(outcome("ply\nformat ascii 1.0\nelement vertex 3\n", "noend.ply"), "malformed line 4");
  EXPECT_EQ(outcome("ply\nelement vertex 0\nend_header\n", "a.ply"), "malformed line 3");
  EXPECT_EQ(outcome("ply\nformat utf 1.0\n", "a.ply"), "malformed line 2");
  EXPECT_EQ(outcome("ply\nformat ascii 2.0\n", "a.ply"), "unsupported line 2");
  EXPECT_EQ(outcome(ascii("element vertex -1\n", ""), "a.ply"), "malformed line 3");
  EXPECT_EQ(outcome(ascii("element vertex 1\nproperty real x\n", ""), "a.ply"), "malformed line 4");
  EXPECT_EQ(outcome(ascii("element vertex 1\nproperty list float int x\n", ""), "a.ply"),
            "malformed line 4");
  EXPECT_EQ(outcome(ascii("element vertex 1\nproperty int x\nproperty int x\n", ""), "a.ply"),
            "malformed line 5");
  EXPECT_EQ(outcome(ascii("element vertex 0\nelement vertex 0\n", ""), "a.ply"),
            "malformed line 4");
  EXPECT_EQ(outcome(ascii("element vertex 1\nproperty int x\nproperty int y\n", "1 2"), "a.ply"),
            "malformed line 7");
  EXPECT_EQ(outcome(ascii(kFace, "3 0 0 0"), "a.ply"), "malformed line 6");
}

TEST(ReadPly, RefusesBadRows) {
  const std::string rows = "0 0 0\n1 0 0\n0 1 0\n";
  EXPECT_EQ(outcome(ascii(kVertex + kFace, rows + "3 0 1 3\n"), "a.ply"), "malformed line 13");
  EXPECT_EQ(outcome(ascii(kVertex + kFace, rows + "3 0 1\n"), "a.ply").substr(0, 9), "malformed");
  EXPECT_EQ(outcome(ascii(kVertex + kFace, rows + "-3 0 1 2\n"), "a.ply"), "malformed line 13");
  EXPECT_EQ(outcome(ascii(kVertex + kFace, rows + "4000000000 0 1 2\n"), "hugen.ply"),
            "malformed line 13");
  EXPECT_EQ(outcome(ascii(kVertex + kFace, "0 nan 0\n"), "a.ply").substr(0, 9), "malformed");
  EXPECT_EQ(outcome(ascii("element vertex 4000000000\nproperty float x\nproperty float y\nproperty "
                          "float z\n" +
                              kFace,
                          "0 0 0\n"),
                    "hugev.ply"),
            "malformed line 10");
  EXPECT_EQ(outcome(ascii("element nothing 18446744073709551615\n" + kVertex, "0 0 0 1 1 1 2 2 2"),
                    "a.ply"),
            "read");
}

TEST(ReadPly, RefusesTruncatedBinary) {
  const std::string header =
      "ply\nformat binary_little_endian 1.0\n" + kVertex + kFace + "end_header\n";
  const std::string rows(36, '\0');
  EXPECT_EQ(outcome(header + rows + std::string("\x03\0\0\0\0\0\0\0\0\0\0\0\0", 13), "a.ply"),
            "read");
  EXPECT_EQ(outcome(header + rows + std::string("\x03\0\0\0\0", 5), "a.ply").substr(0, 14),
            "malformed byte");
  EXPECT_EQ(outcome(header + rows.substr(1), "a.ply").substr(0, 14), "malformed byte");
  EXPECT_EQ(outcome(header + std::string("\0\0\xc0\x7f", 4) + rows.substr(4) + std::string(1, '\0'),
                    "a.ply"),
            "malformed byte " + std::to_string(header.size()));
}

TEST(ReadPly, KeepsDoublesAndUnsignedLists) {
  const MeshFile file = read_text(
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\nproperty "
      "double "
      "z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n1.23456789012345 0 "
      "0\n1 "
      "0 0\n0 1 0\n3 0 1 2\n",
      "dbl.ply");
  EXPECT_EQ(file.mesh().positions[0][0], 1.23456789012345);
  EXPECT_EQ(outcome(ascii("obj_info hello\n" + kVertex +
                              "element face 1\nproperty list uint int vertex_indices\n",
                          "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"),
                    "uintlist.ply"),
            "read");
}

// The first line end tells where binary data begin, even if their first byte is a line feed.
TEST(ReadPly, TakesEveryLineEnd) {
  const std::string lines[] = {"ply",
                               "format ascii 1.0",
                               "element vertex 3",
                               "property float x",
                               "property float y",
                               "property float z",
                               "element face 1",
                               "property list uchar int vertex_indices",
                               "end_header"};
  for (const std::string end : {"\r", "\n", "\r\n"}) {
    std::string header;
    for (const std::string& line : lines) header += line + end;
    const std::string text = header + "0 0 0" + end + "1 0 0\r0 1 0\n3 0 1 2" + end;
    EXPECT_EQ(read_text(text, "a.ply").mesh().triangles.size(), 1U);
    std::string binary = header;
    binary.replace(binary.find("ascii"), 5, "binary_little_endian");
    const float values[9] = {2.8e-45F * 0 + 1.4e-44F, 0, 0, 1, 0, 0, 0, 1, 0};  // begins with 0x0a
    ASSERT_EQ(*reinterpret_cast<const char*>(values), '\n');
    binary.append(reinterpret_cast<const char*>(values), sizeof values);
    const std::int32_t corners[3] = {0, 1, 2};
    binary += '\3';
    binary.append(reinterpret_cast<const char*>(corners), sizeof corners);
    EXPECT_EQ(read_text(binary, "a.ply").mesh().positions[0][0], static_cast<double>(values[0]));
  }
}

}  // namespace
}  // namespace triglyph
