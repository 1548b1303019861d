#include "engine/mesh/weld.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <vector>

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include "engine/base/random.h"

namespace triglyph {
namespace {

std::vector<Vec3> random_vertices(std::size_t n, std::uint64_t distinct) {
  std::vector<Vec3> vertices;
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint64_t pick = random_bits(7, 0, i) % distinct;
    const double sign = random_bits(7, 1, i) % 2 == 0 ? 0.0 : -0.0;
    vertices.emplace_back(random_unit(8, 0, pick), pick % 3 == 0 ? sign : 1.0,
                          static_cast<double>(pick % 1000));
  }
  return vertices;
}

TEST(Weld, JoinsEqualCoordinatesInOrderOfAppearance) {
  const std::vector<Vec3> vertices = {
      {1, 0, 0}, {0, -0.0, 0}, {1, 0, -0.0}, {0, 0, 0}, {1, 0, 1e-300}};
  const Weld welded = weld(vertices);
  EXPECT_EQ(welded.point_of_vertex, (std::vector<std::uint32_t>{0, 1, 0, 1, 2}));
  EXPECT_FALSE(std::signbit(welded.points[1][1]));
  EXPECT_TRUE(weld({}).points.empty());
}

TEST(Weld, AgreesWithAMap) {
  for (const std::size_t n : {1000, 65535, 65536, 200001}) {
    const std::vector<Vec3> vertices = random_vertices(n, n / 3 + 1);
    const Weld welded = weld(vertices);
    std::map<std::array<double, 3>, std::uint32_t> known;
    for (std::size_t i = 0; i < n; ++i) {
      const Vec3& v = vertices[i];
      const auto at =
          known.try_emplace({v[0], v[1], v[2]}, static_cast<std::uint32_t>(known.size()));
      ASSERT_EQ(welded.point_of_vertex[i], at.first->second);
      ASSERT_EQ(welded.points[at.first->second], v);
    }
    ASSERT_EQ(welded.points.size(), known.size());
  }
}

TEST(Weld, IsTheSameForAnyNumberOfThreads) {
  const std::vector<Vec3> vertices = random_vertices(300000, 90000);
  const Weld expected = weld(vertices);
  for (const int threads : {1, 2, 3, 8}) {
    tbb::task_arena arena(threads);
    const Weld welded = arena.execute([&] { return weld(vertices); });
    EXPECT_EQ(welded.point_of_vertex, expected.point_of_vertex) << threads;
    EXPECT_EQ(welded.points, expected.points) << threads;
  }
}

}  // namespace
}  // namespace triglyph
