// The model collection of Debian's assimp-testmodels, where it is installed.
#include <algorithm>
#include <filesystem>
#include <vector>

#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "engine/io/mesh_file.h"

namespace triglyph {
namespace {

TEST(AssimpModels, OpenOrAreRefused) {
  const std::filesystem::path root = "/usr/share/assimp/models";
  if (!std::filesystem::is_directory(root)) GTEST_SKIP() << root << " is not installed";
  std::size_t opened = 0;
  std::size_t fixed = 0;
  for (const char* folder : {"OBJ", "OFF", "PLY", "STL", "invalid", "glTF", "glTF2"}) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root / folder)) {
      if (!entry.is_regular_file()) continue;
      SCOPED_TRACE(entry.path().string());
      try {
        const MeshFile file = MeshFile::open(entry.path());
        ++opened;
        if (!file.why_fixed().empty()) {
          ++fixed;
          EXPECT_THROW((void)file.patched(file.mesh().positions), Error);
          continue;
        }
        const auto bytes = file.bytes();
        ASSERT_TRUE(std::ranges::equal(file.patched(file.mesh().positions), bytes));
        std::vector<Vec3> positions = file.mesh().positions;
        for (Vec3& p : positions) p = file.round(p + Vec3(4, 8, 2) * file.number_step());
        const MeshFile again = MeshFile::read(file.patched(positions), entry.path());
        ASSERT_EQ(again.face_count(), file.face_count());
        for (std::size_t v = 0; v < file.vertex_count(); ++v) {
          ASSERT_EQ(again.mesh().positions[again.point_of_vertex()[v]],
                    positions[file.point_of_vertex()[v]]);
        }
      } catch (const Error& error) {
        EXPECT_FALSE(error.message().empty());
      }
    }
  }
  EXPECT_GE(opened, 60U);
  EXPECT_GE(fixed, 20U);  // coordinates in a .bin of their own, or compressed
}

}  // namespace
}  // namespace triglyph
