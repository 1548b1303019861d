#include "engine/samples/sample_shapes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <tuple>
#include <utility>

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

namespace triglyph {
namespace {

constexpr SampleShape kShapes[] = {SampleShape::Closed, SampleShape::Open, SampleShape::HighGenus};

struct Topology {
  bool is_oriented = true;          // no directed edge twice
  std::int64_t border_edges = 0;    // without a partner
  std::int64_t border_loops = 0;    // closed chains of them
  std::int64_t euler = 0;           // V - E + F
  bool has_one_fan_a_point = true;  // all triangles at a point hang together
  std::size_t lowest_valence = 1000;
  std::size_t highest_valence = 0;
};

Topology inspect(const Mesh& mesh) {
  Topology topology;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> third;  // of a directed edge
  std::vector<std::size_t> triangles_at(mesh.positions.size(), 0);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> some_edge(mesh.positions.size());
  for (const Triangle& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      const std::pair edge(t[k], t[(k + 1) % 3]);
      topology.is_oriented &= third.emplace(edge, t[(k + 2) % 3]).second;
      ++triangles_at[t[k]];
      some_edge[t[k]] = edge;
    }
  }
  std::map<std::uint32_t, std::uint32_t> border;  // next point, along the border
  for (const auto& [edge, apex] : third) {
    if (third.count({edge.second, edge.first}) == 0) border[edge.first] = edge.second;
  }
  topology.border_edges = static_cast<std::int64_t>(border.size());
  const auto edges = static_cast<std::int64_t>(third.size() + border.size()) / 2;
  topology.euler = static_cast<std::int64_t>(mesh.positions.size()) - edges +
                   static_cast<std::int64_t>(mesh.triangles.size());
  for (std::uint32_t point = 0; point < mesh.positions.size(); ++point) {
    topology.lowest_valence = std::min(topology.lowest_valence, triangles_at[point]);
    topology.highest_valence = std::max(topology.highest_valence, triangles_at[point]);
    // Turn around the point from its border, or from anywhere.
    const auto start = border.find(point);
    std::uint32_t tip = start != border.end() ? start->second : some_edge[point].second;
    std::size_t turned = 0;
    for (auto at = third.find({point, tip}); at != third.end() && turned < triangles_at[point];
         at = third.find({point, tip})) {
      tip = at->second;
      ++turned;
    }
    const bool closes = start != border.end() || tip == some_edge[point].second;
    topology.has_one_fan_a_point &= turned == triangles_at[point] && closes;
  }
  while (!border.empty()) {
    ++topology.border_loops;
    std::uint32_t at = border.begin()->first;
    for (auto next = border.find(at); next != border.end(); next = border.find(at)) {
      at = next->second;
      border.erase(next);
    }
  }
  return topology;
}

double volume_of(const Mesh& mesh) {
  double six = 0;
  for (const Triangle& t : mesh.triangles) {
    six += dot(mesh.positions[t[0]], cross(mesh.positions[t[1]], mesh.positions[t[2]]));
  }
  return six / 6;
}

TEST(SampleShapes, AreManifoldAndOfTheGenusTheyClaim) {
  for (const SampleShape shape : kShapes) {
    for (const std::size_t triangles : {64U, 100U, 333U, 1000U, 5000U, 30000U}) {
      for (std::uint64_t seed = 0; seed < 3; ++seed) {
        SCOPED_TRACE(testing::Message()
                     << static_cast<int>(shape) << ' ' << triangles << ' ' << seed);
        const Topology topology = inspect(make_sample_shape(shape, triangles, seed));
        EXPECT_TRUE(topology.is_oriented);
        EXPECT_TRUE(topology.has_one_fan_a_point);
        const bool is_open = shape == SampleShape::Open;
        EXPECT_EQ(topology.border_loops, is_open ? 1 : 0);
        EXPECT_EQ(topology.border_edges == 0, !is_open);
        const auto genus = static_cast<std::int64_t>(genus_of_sample(shape, triangles, seed));
        EXPECT_EQ(topology.euler, is_open ? 1 : 2 - 2 * genus);
        EXPECT_EQ(genus > 0, shape == SampleShape::HighGenus);
        EXPECT_GE(topology.lowest_valence, is_open ? 1U : 3U);
        EXPECT_LE(topology.highest_valence, 10U);
      }
    }
  }
}

TEST(SampleShapes, HaveAboutTheTrianglesAskedFor) {
  for (const SampleShape shape : kShapes) {
    for (std::size_t triangles = 40; triangles < 300000; triangles += 1 + triangles / 17) {
      if (shape == SampleShape::HighGenus && triangles < 64) continue;
      const auto count =
          static_cast<double>(make_sample_shape(shape, triangles, 5).triangles.size());
      const auto asked = static_cast<double>(triangles);
      EXPECT_NEAR(count, asked, 0.1 * asked) << static_cast<int>(shape);
    }
  }
}

TEST(SampleShapes, HaveNoDegenerateTriangleAndDistinctPoints) {
  for (const SampleShape shape : kShapes) {
    for (const std::size_t triangles : {64U, 500U, 40000U}) {
      Mesh mesh = make_sample_shape(shape, triangles, 11);
      double total = 0;
      double least = 1e300;
      for (const Triangle& t : mesh.triangles) {
        const double area = triangle_area(mesh.positions, t);
        total += area;
        least = std::min(least, area);
      }
      EXPECT_GT(least, 0.02 * total / static_cast<double>(mesh.triangles.size()));
      std::sort(mesh.positions.begin(), mesh.positions.end(), [](const Vec3& a, const Vec3& b) {
        return std::tie(a[0], a[1], a[2]) < std::tie(b[0], b[1], b[2]);
      });
      EXPECT_EQ(std::adjacent_find(mesh.positions.begin(), mesh.positions.end()),
                mesh.positions.end());
    }
  }
}

TEST(SampleShapes, ClosedOnesFaceOutwards) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    EXPECT_GT(volume_of(make_sample_shape(SampleShape::Closed, 5000, seed)), 2.0);
    EXPECT_GT(volume_of(make_sample_shape(SampleShape::HighGenus, 5000, seed)), 0.3);
  }
}

// Neighbouring triangles whose normals point against each other would be a fold.
TEST(SampleShapes, DoNotFold) {
  for (const SampleShape shape : kShapes) {
    const Mesh mesh = make_sample_shape(shape, 60000, 2);
    std::map<std::pair<std::uint32_t, std::uint32_t>, Vec3> normal_at;
    for (const Triangle& t : mesh.triangles) {
      const Vec3& a = mesh.positions[t[0]];
      const Vec3 normal = cross(mesh.positions[t[1]] - a, mesh.positions[t[2]] - a).normalized();
      for (int k = 0; k < 3; ++k) normal_at[{t[k], t[(k + 1) % 3]}] = normal;
    }
    double sharpest = 1;
    std::size_t flat = 0;
    for (const auto& [edge, normal] : normal_at) {
      const auto other = normal_at.find({edge.second, edge.first});
      if (other == normal_at.end()) continue;
      const double cosine = dot(normal, other->second);
      sharpest = std::min(sharpest, cosine);
      flat += cosine > 1 - 1e-12 ? 1 : 0;
    }
    // The slab has edges of 90 degrees, more or less, before it is bent.
    EXPECT_GT(sharpest, shape == SampleShape::HighGenus ? -0.8 : 0.5);
    EXPECT_LT(flat, normal_at.size() / 1000);
  }
}

TEST(SampleShapes, DependOnTheSeedAndNothingElse) {
  for (const SampleShape shape : kShapes) {
    const Mesh expected = make_sample_shape(shape, 20000, 3);
    for (const int threads : {1, 2, 3, 8}) {
      tbb::task_arena arena(threads);
      const Mesh mesh = arena.execute([&] { return make_sample_shape(shape, 20000, 3); });
      EXPECT_EQ(mesh.positions, expected.positions);
      EXPECT_EQ(mesh.triangles, expected.triangles);
    }
    const Mesh other = make_sample_shape(shape, 20000, 4);
    EXPECT_NE(other.positions, expected.positions);
    EXPECT_NE(other.triangles, expected.triangles);
  }
}

TEST(SampleShapes, RefuseToBeTiny) {
  EXPECT_THROW((void)make_sample_shape(SampleShape::Closed, 39, 0), std::logic_error);
  EXPECT_THROW((void)make_sample_shape(SampleShape::HighGenus, 63, 0), std::logic_error);
}

// The range that `triglyph sample` states. A slab with a hole has 64 or 80 triangles, none between.
TEST(SampleShapes, HaveWithinATenthAsManyTrianglesAsWanted) {
  std::vector<std::size_t> wanted;
  for (std::size_t triangles = 80; triangles <= 1200; ++triangles) wanted.push_back(triangles);
  for (std::size_t triangles = 1201; triangles < 500'000; triangles = triangles * 9 / 5) {
    wanted.push_back(triangles);
  }
  for (const SampleShape shape : kShapes) {
    for (const std::size_t triangles : wanted) {
      for (const std::uint64_t seed : {1, 2, 3}) {
        if (seed > 1 && shape != SampleShape::HighGenus) continue;  // their plan is the same
        const auto made =
            static_cast<double>(make_sample_shape(shape, triangles, seed).triangles.size());
        EXPECT_NEAR(made / static_cast<double>(triangles), 1, 0.1)
            << triangles << ", shape " << static_cast<int>(shape) << ", seed " << seed;
      }
    }
  }
}

}  // namespace
}  // namespace triglyph
