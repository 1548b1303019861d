#include "engine/io/packed_mesh.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "engine/base/random.h"
#include "tests/support/motions.h"

namespace triglyph {
namespace {

TEST(PackedMesh, HasItsTrianglesAndRoundedPoints) {
  Mesh mesh = test::sphere(30, 1);
  for (Vec3& p : mesh.positions) p = Vec3(1e6 + 3 * p[0], p[1], 0.1 * p[2]);
  const std::vector<char> bytes = packed(mesh);
  EXPECT_LT(bytes.size(), 12 * mesh.positions.size());
  const std::optional<Mesh> again = unpacked(bytes);
  ASSERT_TRUE(again);
  ASSERT_EQ(again->positions.size(), mesh.positions.size());
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    EXPECT_LE((again->positions[i] - mesh.positions[i]).norm(), 6.0 / 65535);
  }
  ASSERT_EQ(again->triangles.size(), mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    Triangle turned = again->triangles[i];
    std::rotate(turned.begin(), std::find(turned.begin(), turned.end(), mesh.triangles[i][0]),
                turned.end());
    EXPECT_EQ(turned, mesh.triangles[i]);
  }
  EXPECT_EQ(packed(*again), bytes);
}

TEST(PackedMesh, MayBeEmptyOrAPoint) {
  for (const Mesh& mesh : {Mesh(), Mesh{{Vec3(1, 2, 3)}, {}}}) {
    const std::optional<Mesh> again = unpacked(packed(mesh));
    ASSERT_TRUE(again);
    EXPECT_EQ(again->positions, mesh.positions);
  }
}

TEST(PackedMesh, OfOtherBytesIsNothing) {
  const std::vector<char> bytes = packed(test::sphere(10, 1));
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_FALSE(unpacked({bytes.data(), size})) << size;
  }
  for (std::uint64_t trial = 0; trial < 2000; ++trial) {
    std::vector<char> damaged = bytes;
    for (std::uint64_t i = 0; i < 3; ++i) {
      const std::uint64_t bits = random_bits(1, trial, i);
      damaged[bits % damaged.size()] = static_cast<char>(bits >> 32);
    }
    const std::optional<Mesh> mesh = unpacked(damaged);  // anything but a crash
    if (!mesh) continue;
    for (const Triangle& t : mesh->triangles) {
      EXPECT_LT(*std::max_element(t.begin(), t.end()), mesh->positions.size());
    }
  }
}

}  // namespace
}  // namespace triglyph
