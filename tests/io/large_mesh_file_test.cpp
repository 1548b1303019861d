// Files large enough to be cut into blocks for several threads.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include "engine/base/random.h"
#include "engine/io/export_mesh.h"
#include "engine/io/mesh_file.h"

namespace triglyph {
namespace {

constexpr std::uint32_t kSide = 260;  // more vertices than one block patches

Mesh make_hills() {
  Mesh mesh;
  for (std::uint32_t i = 0; i < kSide * kSide; ++i) {
    mesh.positions.emplace_back(i % kSide * 0.25, i / kSide * 0.25, std::sin(i * 0.01));
  }
  for (std::uint32_t i = 0; i + kSide + 1 < kSide * kSide; ++i) {
    if (i % kSide + 1 == kSide) continue;
    mesh.triangles.push_back({i, i + 1, i + kSide});
    mesh.triangles.push_back({i + 1, i + kSide + 1, i + kSide});
  }
  return mesh;
}

struct Trip {
  std::vector<char> exported;
  std::vector<char> patched;
  std::vector<Vec3> wanted;
};

Trip travel(const Mesh& mesh, FileFormat format) {
  Trip trip;
  trip.exported = export_mesh(mesh, {format, false, 7});
  const std::string name = "a." + std::string(name_of(format).substr(0, 3));
  const MeshFile file = MeshFile::read(trip.exported, name);
  trip.wanted = file.mesh().positions;
  for (std::size_t i = 0; i < trip.wanted.size(); ++i) {
    if (i % 3 == 0) continue;
    Vec3& p = trip.wanted[i];
    p = file.round(p + Vec3(random_unit(1, 0, i), random_unit(1, 1, i), 0.01) * 0.01);
  }
  trip.patched = file.patched(trip.wanted);
  const MeshFile again = MeshFile::read(trip.patched, name);
  EXPECT_EQ(again.mesh().positions, trip.wanted);
  EXPECT_EQ(again.mesh().triangles, file.mesh().triangles);
  return trip;
}

TEST(LargeMeshFile, IsTheSameForAnyNumberOfThreads) {
  const Mesh mesh = make_hills();
  for (const FileFormat format : {FileFormat::Obj, FileFormat::PlyBig, FileFormat::StlAscii}) {
    const Trip expected = travel(mesh, format);
    for (const int threads : {1, 2, 3, 8}) {
      tbb::task_arena arena(threads);
      const Trip trip = arena.execute([&] { return travel(mesh, format); });
      EXPECT_TRUE(trip.exported == expected.exported) << name_of(format) << threads;
      EXPECT_TRUE(trip.patched == expected.patched) << name_of(format) << threads;
    }
  }
}

}  // namespace
}  // namespace triglyph
