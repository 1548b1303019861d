// Marks nothing but moves points of random files and looks at every byte of the result.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "engine/io/mesh_file.h"
#include "engine/mesh/triangulate.h"
#include "tests/io/random_mesh_file.h"

namespace triglyph::test {
namespace {

// TRIGLYPH_FILES asks for more; .ci/nightly takes 100,000.
std::uint64_t files_of_a_kind() {
  const char* asked = std::getenv("TRIGLYPH_FILES");
  return asked == nullptr ? 1000 : std::strtoull(asked, nullptr, 10);
}

std::vector<char> as_bytes(const std::string& text) {
  return {text.begin(), text.end()};
}

// Points by first appearance, by comparison in a map.
struct SimpleWeld {
  std::vector<std::uint32_t> point_of;
  std::vector<Vec3> points;
};

SimpleWeld weld_simply(const std::vector<std::array<double, 3>>& values) {
  SimpleWeld welded;
  std::map<std::array<double, 3>, std::uint32_t> known;  // -0 and 0 are equivalent keys
  for (const auto& v : values) {
    const auto [at, is_new] = known.try_emplace(v, static_cast<std::uint32_t>(known.size()));
    if (is_new) welded.points.emplace_back(v[0], v[1], v[2]);
    welded.point_of.push_back(at->second);
  }
  return welded;
}

void expect_content(const MeshFile& file, const RandomMeshFile& made,
                    const std::vector<std::array<double, 3>>& values) {
  ASSERT_EQ(file.vertex_count(), values.size());
  ASSERT_EQ(file.face_count(), made.faces.size());
  const SimpleWeld welded = weld_simply(values);
  ASSERT_TRUE(std::equal(welded.point_of.begin(), welded.point_of.end(),
                         file.point_of_vertex().begin(), file.point_of_vertex().end()));
  ASSERT_EQ(file.mesh().positions, welded.points);
  Faces faces;
  bool has_polygons = false;
  std::vector<Triangle> plain;
  for (const auto& face : made.faces) {
    faces.corners.insert(faces.corners.end(), face.begin(), face.end());
    faces.ends.push_back(static_cast<std::uint32_t>(faces.corners.size()));
    has_polygons |= face.size() != 3;
    const std::uint32_t a = welded.point_of[face[0]], b = welded.point_of[face[1]],
                        c = welded.point_of[face[2]];
    if (a != b && b != c && c != a) plain.push_back({a, b, c});
  }
  ASSERT_EQ(file.mesh().triangles,
            has_polygons ? triangulate(faces, welded.point_of, welded.points) : plain);
}

std::vector<Vec3> move_some(const MeshFile& file, std::mt19937_64& random) {
  std::vector<Vec3> positions = file.mesh().positions;
  for (Vec3& p : positions) {
    if (random() % 3 == 0) continue;
    for (int axis = 0; axis < 3; ++axis) {
      if (random() % 4 == 0) continue;
      const double unit = static_cast<double>(random() >> 11) * 0x1p-53 - 0.5;
      const double step = file.number_step();
      p[axis] += unit * (random() % 2 == 0 ? 8 * step : std::abs(p[axis]) * 0.01);
    }
    if (random() % 2 == 0) p = file.round(p);
  }
  return positions;
}

bool is_number_byte(char c) {
  return (c >= '0' && c <= '9') || c == '+' || c == '-' || c == '.' || c == 'e' || c == 'E';
}

// Walks through both files side by side; returns the values that `patched` holds.
std::vector<std::array<double, 3>> compare_bytes(const RandomMeshFile& made, const MeshFile& file,
                                                 const std::vector<Vec3>& positions,
                                                 const std::string& patched) {
  struct Place {
    ByteSpan span;
    std::size_t vertex;
    std::size_t axis;
  };
  std::vector<Place> places;
  for (std::size_t v = 0; v < made.spans.size(); ++v) {
    for (std::size_t a = 0; a < 3; ++a) places.push_back({made.spans[v][a], v, a});
  }
  std::sort(places.begin(), places.end(),
            [](const Place& a, const Place& b) { return a.span.begin < b.span.begin; });
  std::vector<std::array<double, 3>> values = made.values;
  std::size_t in = 0, out = 0;
  for (const Place& place : places) {
    const std::size_t gap = place.span.begin - in;
    EXPECT_EQ(patched.compare(out, gap, made.bytes, in, gap), 0)
        << "before byte " << place.span.begin;
    out += gap;
    in = place.span.begin + place.span.size;
    ByteSpan now{out, place.span.size};
    if (made.is_text) {
      while (out < patched.size() && is_number_byte(patched[out])) ++out;
      now.size = out - now.begin;
    } else {
      out += place.span.size;
    }
    const int axis = static_cast<int>(place.axis);
    const Vec3& to = positions[file.point_of_vertex()[place.vertex]];
    const double old = made.values[place.vertex][place.axis];
    const NumberKind kind = made.is_text ? NumberKind::Text : made.kind[place.axis];
    values[place.vertex][place.axis] = decode(patched, now, kind, made.is_big_endian);
    const std::string token = patched.substr(now.begin, now.size);
    if (to[axis] == old || file.round(to)[axis] == old) {
      EXPECT_EQ(token, made.bytes.substr(place.span.begin, place.span.size));
    } else {
      EXPECT_EQ(values[place.vertex][place.axis], file.round(to)[axis]) << token;
      EXPECT_FALSE(made.is_text && token[0] == '-' && values[place.vertex][place.axis] == 0)
          << token;
    }
  }
  EXPECT_EQ(patched.substr(out), made.bytes.substr(in));
  return values;
}

class PatchedFile : public testing::TestWithParam<int> {};

TEST_P(PatchedFile, DiffersInMovedCoordinatesAlone) {
  for (std::uint64_t seed = 0; seed < files_of_a_kind(); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const RandomMeshFile made = random_mesh_file(static_cast<Kind>(GetParam()), seed);
    const MeshFile file = MeshFile::read(as_bytes(made.bytes), made.name);
    ASSERT_NO_FATAL_FAILURE(expect_content(file, made, made.values)) << made.bytes;
    ASSERT_EQ(file.patched(file.mesh().positions), as_bytes(made.bytes));

    std::mt19937_64 random(seed + 1);
    const std::vector<Vec3> positions = move_some(file, random);
    for (const Vec3& p : positions) ASSERT_EQ(file.round(file.round(p)), file.round(p));
    const std::vector<char> out = file.patched(positions);
    const std::string patched(out.begin(), out.end());
    ASSERT_TRUE(made.is_text || patched.size() == made.bytes.size());
    const auto values = compare_bytes(made, file, positions, patched);
    ASSERT_FALSE(HasFailure()) << made.bytes << "\n----\n" << patched;

    const MeshFile again = MeshFile::read(out, made.name);
    ASSERT_NO_FATAL_FAILURE(expect_content(again, made, values));
    for (std::size_t v = 0; v < file.vertex_count(); ++v) {
      const std::uint32_t point = file.point_of_vertex()[v];
      const auto first =
          std::find(file.point_of_vertex().begin(), file.point_of_vertex().end(), point);
      ASSERT_EQ(again.point_of_vertex()[v], again.point_of_vertex()[static_cast<std::size_t>(
                                                first - file.point_of_vertex().begin())]);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(AllKinds, PatchedFile, testing::Range(0, kKinds));

// Truncations, flipped bytes and edited digits of valid files.
std::string mutate(std::string bytes, std::mt19937_64& random) {
  const auto at = [&] { return random() % bytes.size(); };
  for (std::size_t edits = 1 + random() % 3; edits > 0 && !bytes.empty(); --edits) {
    switch (random() % 5) {
      case 0:
        bytes.resize(at());
        break;
      case 1:
        bytes[at()] = static_cast<char>(random());
        break;
      case 2:
        bytes.erase(at(), 1 + random() % 4);
        break;
      case 3:
        bytes.insert(at(), std::string(1 + random() % 3, "09-/. \n\\#"[random() % 9]));
        break;
      default: {
        // A number near the start is often a count of the header.
        const std::size_t digit =
            bytes.find_first_of("0123456789", random() % std::min<std::size_t>(bytes.size(), 200));
        if (digit != std::string::npos) bytes.insert(digit, "99999999");
      }
    }
  }
  return bytes;
}

class MutatedFile : public testing::TestWithParam<int> {};

TEST_P(MutatedFile, IsReadOrRefused) {
  std::size_t read = 0, refused = 0;
  for (std::uint64_t seed = 0; seed < 1500; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(seed);
    const RandomMeshFile made = random_mesh_file(static_cast<Kind>(GetParam()), seed % 50);
    const std::string bytes = mutate(made.bytes, random);
    try {
      const MeshFile file = MeshFile::read(as_bytes(bytes), made.name);
      ASSERT_LE(file.vertex_count(), bytes.size());
      std::vector<Vec3> positions = file.mesh().positions;
      for (Vec3& p : positions) p = file.round(p * 1.01);
      const bool is_finite = std::all_of(positions.begin(), positions.end(), [](const Vec3& p) {
        return std::isfinite(p[0] + p[1] + p[2]);
      });
      if (is_finite) {
        const MeshFile again = MeshFile::read(file.patched(positions), made.name);
        ASSERT_EQ(again.vertex_count(), file.vertex_count());
        ASSERT_EQ(again.face_count(), file.face_count());
      }
      ++read;
    } catch (const Error& error) {
      EXPECT_FALSE(error.message().empty());
      ++refused;
    }
  }
  EXPECT_GT(read, 0U);
  EXPECT_GT(refused, 0U);
}

INSTANTIATE_TEST_SUITE_P(AllKinds, MutatedFile, testing::Range(0, kKinds));

}  // namespace
}  // namespace triglyph::test
