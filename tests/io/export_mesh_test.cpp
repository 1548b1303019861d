#include "engine/io/export_mesh.h"

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/base/random.h"
#include "engine/io/mesh_file.h"

namespace triglyph {
namespace {

// A sheet of triangles in which every point is used, first by the first triangles.
Mesh make_sheet(std::uint32_t side) {
  Mesh mesh;
  for (std::uint32_t i = 0; i < side * side; ++i) {
    mesh.positions.emplace_back(i % side + random_unit(1, 0, i), i / side + random_unit(1, 1, i),
                                random_unit(1, 2, i) / 3);
  }
  for (std::uint32_t y = 0; y + 1 < side; ++y) {
    for (std::uint32_t x = 0; x + 1 < side; ++x) {
      const std::uint32_t a = y * side + x;
      mesh.triangles.push_back({a, a + 1, a + side});
      mesh.triangles.push_back({a + 1, a + side + 1, a + side});
    }
  }
  return mesh;
}

std::string ending(FileFormat format) {
  return "a." + std::string(name_of(format).substr(0, 3));
}

TEST(ExportMesh, ReadsBackAsItWas) {
  const Mesh mesh = make_sheet(200);
  for (const FileFormat format : {FileFormat::Obj, FileFormat::Off, FileFormat::PlyAscii,
                                  FileFormat::PlyLittle, FileFormat::PlyBig}) {
    const MeshFile file = MeshFile::read(export_mesh(mesh, {format, true, 0}), ending(format));
    EXPECT_EQ(file.format(), format);
    EXPECT_EQ(file.mesh().positions, mesh.positions);
    EXPECT_EQ(file.mesh().triangles, mesh.triangles);
  }
}

TEST(ExportMesh, RoundsToFloats) {
  const Mesh mesh = make_sheet(20);
  for (const FileFormat format :
       {FileFormat::PlyAscii, FileFormat::PlyLittle, FileFormat::PlyBig}) {
    const MeshFile file = MeshFile::read(export_mesh(mesh, {format, false, 0}), ending(format));
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_EQ(static_cast<float>(file.mesh().positions[i][axis]),
                  static_cast<float>(mesh.positions[i][axis]));
      }
    }
  }
}

TEST(ExportMesh, KeepsTheTrianglesOfStl) {
  const Mesh mesh = make_sheet(60);
  for (const FileFormat format : {FileFormat::StlAscii, FileFormat::StlBinary}) {
    const MeshFile file = MeshFile::read(export_mesh(mesh, {format, true, 0}), ending(format));
    EXPECT_EQ(file.format(), format);
    ASSERT_EQ(file.mesh().triangles.size(), mesh.triangles.size());
    EXPECT_EQ(file.mesh().positions.size(), mesh.positions.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      for (std::size_t corner = 0; corner < 3; ++corner) {
        const Vec3& expected = mesh.positions[mesh.triangles[t][corner]];
        const Vec3& found = file.mesh().positions[file.mesh().triangles[t][corner]];
        EXPECT_LT((expected - found).norm(), format == FileFormat::StlAscii ? 1e-300 : 1e-4);
      }
    }
  }
}

TEST(ExportMesh, WritesTheDigitsAsked) {
  Mesh mesh;
  mesh.positions = {{0.123456789, -0.0, 100}};
  const std::vector<char> bytes = export_mesh(mesh, {FileFormat::Obj, false, 3});
  EXPECT_EQ(std::string(bytes.begin(), bytes.end()), "v 0.123 0 100\n");
}

}  // namespace
}  // namespace triglyph
