#include "engine/attack/collusion.h"

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/attack/attack_file.h"
#include "engine/attack/coordinates.h"
#include "engine/attack/copies.h"
#include "engine/attack/indexing.h"
#include "engine/base/error.h"
#include "engine/base/output_file.h"
#include "engine/io/export_mesh.h"
#include "tests/support/arenas.h"
#include "tests/support/shapes.h"
#include "tests/support/temp_folder.h"

namespace triglyph {
namespace {

namespace fs = std::filesystem;

// Copies that differ a little at every point, as marks of several recipients do.
std::vector<Mesh> noisy_copies(std::size_t count) {
  const Mesh mesh = make_sample_shape(SampleShape::Closed, 2000, 7);
  std::vector<Mesh> copies;
  for (std::size_t i = 0; i < count; ++i) copies.push_back(with_uniform_noise(mesh, 0.001, i));
  return copies;
}

std::vector<Vec3> points_of(std::span<const Mesh> copies, Collusion collusion,
                            std::uint64_t seed = 1) {
  return colluded(copies, collusion, seed).positions;
}

// How many points come from each copy; a point from none fails the test.
std::vector<std::size_t> shares_of(std::span<const Mesh> copies, std::span<const Vec3> points) {
  std::vector<std::size_t> shares(copies.size(), 0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto source = std::find_if(copies.begin(), copies.end(), [&](const Mesh& copy) {
      return copy.positions[i] == points[i];
    });
    EXPECT_NE(source, copies.end()) << i;
    if (source != copies.end()) ++shares[std::size_t(source - copies.begin())];
  }
  return shares;
}

template <typename Work>
std::string reason_of(const Work& work) {
  try {
    work();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::Usage);
    return error.what();
  }
  return "";
}

TEST(Collusion, OfEqualCopiesIsTheCopy) {
  for (const std::size_t count : {2U, 3U, 7U, 49U}) {
    const std::vector<Mesh> copies(count, noisy_copies(1)[0]);
    for (const CollusionKind& kind : collusion_kinds()) {
      const Mesh result = colluded(copies, kind.collusion, 3);
      EXPECT_EQ(result.positions, copies[0].positions) << kind.name << ", " << count;
      EXPECT_EQ(result.triangles, copies[0].triangles);
    }
  }
}

TEST(Collusion, TakesWhatItsNameSays) {
  const auto at = [](double x, double y, double z) { return Mesh{{Vec3(x, y, z)}, {}}; };
  const std::vector<Mesh> three{at(1, 5, -2), at(1, 3, 2), at(4, 4, 9)};
  EXPECT_EQ(points_of(three, Collusion::Average)[0], Vec3(2, 4, 3));
  EXPECT_EQ(points_of(three, Collusion::Majority)[0], Vec3(1, 4, 2));
  EXPECT_EQ(points_of(three, Collusion::Minimum)[0], Vec3(1, 3, -2));
  EXPECT_EQ(points_of(three, Collusion::Maximum)[0], Vec3(4, 5, 9));
  const std::vector<Mesh> four{at(1, 5, -2), at(1, 3, 2), at(4, 4, 9), at(8, 3, 3)};
  EXPECT_EQ(points_of(four, Collusion::Majority)[0], Vec3(2.5, 3.5, 2.5));
}

TEST(Collusion, ByValuesDoesNotDependOnTheOrderOfTheCopies) {
  std::vector<Mesh> copies = noisy_copies(5);
  std::vector<Mesh> turned = copies;
  std::rotate(turned.begin(), turned.begin() + 2, turned.end());
  std::swap(turned[0], turned[1]);
  for (const Collusion collusion : {Collusion::Average, Collusion::Majority, Collusion::Minimum,
                                    Collusion::Maximum, Collusion::Extremes}) {
    EXPECT_EQ(points_of(turned, collusion), points_of(copies, collusion));
  }
}

TEST(Collusion, LiesBetweenTheExtremes) {
  for (const std::size_t count : {2U, 3U, 4U}) {
    const std::vector<Mesh> copies = noisy_copies(count);
    const auto least = points_of(copies, Collusion::Minimum);
    const auto greatest = points_of(copies, Collusion::Maximum);
    const auto extremes = points_of(copies, Collusion::Extremes);
    std::size_t low = 0;
    for (const Collusion collusion : {Collusion::Average, Collusion::Majority, Collusion::Pick}) {
      const auto points = points_of(copies, collusion);
      for (std::size_t i = 0; i < points.size(); ++i) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
          EXPECT_LE(least[i][axis], points[i][axis]);
          EXPECT_LE(points[i][axis], greatest[i][axis]);
        }
      }
    }
    for (std::size_t i = 0; i < extremes.size(); ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const bool is_low = extremes[i][axis] == least[i][axis];
        EXPECT_TRUE(is_low || extremes[i][axis] == greatest[i][axis]);
        low += is_low ? 1 : 0;
      }
    }
    EXPECT_NEAR(double(low) / double(3 * extremes.size()), 0.5, 0.05);
  }
}

TEST(Collusion, PickAndMixTakeEveryPointFromACopyAndUseEachCopy) {
  for (const std::size_t count : {2U, 5U, 30U}) {
    const std::vector<Mesh> copies = noisy_copies(count);
    for (const Collusion collusion : {Collusion::Pick, Collusion::Mix}) {
      const auto shares = shares_of(copies, points_of(copies, collusion, count));
      EXPECT_GT(*std::min_element(shares.begin(), shares.end()), 0U) << count;
    }
  }
  const std::vector<Mesh> two = noisy_copies(2);
  const auto shares = shares_of(two, points_of(two, Collusion::Pick));
  EXPECT_NEAR(double(shares[0]) / double(shares[0] + shares[1]), 0.5, 0.07);
}

// Of the edges few join points of two copies in a mix, about half in a pick of two.
TEST(Collusion, MixTakesRegionsWhole) {
  const std::vector<Mesh> copies = noisy_copies(2);
  const auto cut_share = [&](Collusion collusion) {
    const auto points = points_of(copies, collusion);
    const auto is_first = [&](std::uint32_t p) { return points[p] == copies[0].positions[p]; };
    std::size_t cut = 0;
    for (const Triangle& t : copies[0].triangles) cut += is_first(t[0]) != is_first(t[1]) ? 1 : 0;
    return double(cut) / double(copies[0].triangles.size());
  };
  EXPECT_LT(cut_share(Collusion::Mix), 0.15);
  EXPECT_GT(cut_share(Collusion::Mix), 0);
  EXPECT_GT(cut_share(Collusion::Pick), 0.4);
}

TEST(Collusion, DependsOnCopiesAndSeedAlone) {
  const Mesh& ball = test::bumpy_ball().mesh;  // of more than one block of points
  ASSERT_GT(ball.positions.size(), 4096U);
  const std::vector<Mesh> copies{ball, with_uniform_noise(ball, 0.001, 1),
                                 with_uniform_noise(ball, 0.001, 2)};
  for (const CollusionKind& kind : collusion_kinds()) {
    SCOPED_TRACE(kind.name);
    test::expect_same_for_any_threads([&] { return points_of(copies, kind.collusion, 5); });
    EXPECT_EQ(points_of(copies, kind.collusion, 6) != points_of(copies, kind.collusion, 5),
              kind.draws_lots);
  }
}

TEST(Collusion, CopesWithFewPointsAndNone) {
  for (const CollusionKind& kind : collusion_kinds()) {
    EXPECT_TRUE(points_of(std::vector<Mesh>(2), kind.collusion).empty()) << kind.name;
    const std::vector<Mesh> small(9, test::tetrahedron());
    EXPECT_EQ(points_of(small, kind.collusion), small[0].positions) << kind.name;
  }
}

TEST(Collusion, RefusesWhatAreNoCopiesAndNamesTheCopy) {
  const auto says = [](const std::vector<Mesh>& copies) {
    return reason_of([&] { (void)colluded(copies, Collusion::Average, 1); });
  };
  const Mesh grid = test::flat_grid(3, 2);
  Mesh larger = grid;
  larger.positions.emplace_back(9, 9, 9);
  Mesh fewer = grid;
  fewer.triangles.pop_back();
  Mesh turned = grid;
  std::swap(turned.triangles[4][0], turned.triangles[4][1]);
  EXPECT_EQ(says({}), "a collusion takes two copies or more, not 0");
  EXPECT_EQ(says({grid}), "a collusion takes two copies or more, not 1");
  EXPECT_EQ(says({grid, grid, larger}), "copy 3 has 13 points, the first 12");
  EXPECT_EQ(says({grid, fewer, larger}), "copy 2 has 11 triangles, the first 12");
  EXPECT_EQ(says({grid, turned}), "copy 2 differs from the first at triangle 5");
}

TEST(Collusion, KindsHaveNamesOfTheirOwnAndAreFoundByThem) {
  std::set<std::string_view> names;
  for (const CollusionKind& kind : collusion_kinds()) {
    EXPECT_TRUE(names.insert(kind.name).second) << kind.name;
    EXPECT_EQ(collusion_named(kind.name).collusion, kind.collusion);
    EXPECT_FALSE(kind.help.empty());
  }
  const auto says = [](const char* name) {
    return reason_of([&] { (void)collusion_named(name); });
  };
  EXPECT_EQ(says("avarage"), "there is no collusion named \"avarage\"; did you mean average?");
  EXPECT_NE(says("bananas").find("it is one of average, majority"), std::string::npos);
}

class CopiesInFiles : public testing::Test {
 protected:
  fs::path write(const std::string& name, const Mesh& mesh, FileFormat format) const {
    OutputFile file(folder_ / name);
    file.write(export_mesh(mesh, {.format = format, .significant_digits = 9}));
    file.commit();
    return folder_ / name;
  }
  fs::path write_text(const std::string& name, const std::string& text) const {
    OutputFile file(folder_ / name);
    file.write(std::vector<char>(text.begin(), text.end()));
    file.commit();
    return folder_ / name;
  }
  // What is said of the second file, without its folder.
  [[nodiscard]] std::string refusal(const fs::path& first, const fs::path& second) const {
    std::string text = reason_of([&] { (void)read_copies(std::vector{first, second}); });
    const std::string folder = folder_.path().string() + "/";
    for (auto at = text.find(folder); at != text.npos; at = text.find(folder)) {
      text.erase(at, folder.size());
    }
    return text;
  }

  test::TempFolder folder_;
};

// The same points, whether a file stores them once, at every triangle, or in another order.
TEST_F(CopiesInFiles, AreNumberedAlikeWhateverTheirFormat) {
  const std::vector<Mesh> copies = noisy_copies(2);
  // other numbers for the points, the same faces
  Mesh renumbered = copies[1];
  std::reverse(renumbered.positions.begin(), renumbered.positions.end());
  const auto last = std::uint32_t(renumbered.positions.size() - 1);
  for (Triangle& t : renumbered.triangles) t = {last - t[0], last - t[1], last - t[2]};
  const fs::path first = write("a.obj", copies[0], FileFormat::Obj);
  const Copies same =
      read_copies(std::vector{first, write("b.obj", copies[1], FileFormat::Obj),
                              write("b.stl", copies[1], FileFormat::StlBinary),
                              write("b.ply", renumbered, FileFormat::PlyLittle),
                              write("soup.off", as_soup(copies[1]), FileFormat::Off)});
  EXPECT_EQ(same.format, FileFormat::Obj);
  ASSERT_EQ(same.meshes.size(), 5U);
  EXPECT_EQ(same.meshes[0].positions, MeshFile::open(first).mesh().positions);
  for (std::size_t i = 1; i < 5; ++i) {
    EXPECT_EQ(same.meshes[i].triangles, same.meshes[0].triangles);
    ASSERT_EQ(same.meshes[i].positions.size(), same.meshes[1].positions.size());
    for (std::size_t p = 0; p < same.meshes[i].positions.size(); ++p) {
      const Vec3 apart = same.meshes[i].positions[p] - same.meshes[1].positions[p];
      ASSERT_LT(apart.norm(), 1e-6) << i << ", " << p;  // STL holds floats
    }
  }
}

// The diagonal of the quadrangle depends on where its corners lie.
TEST_F(CopiesInFiles, HavePolygonsCutAsInTheFirst) {
  const std::string faces = "f 1 2 3 4\nf 1 5 2\n";
  const std::string rest = "v 0 1 0\nv 0 -1 1\n" + faces;
  const fs::path first = write_text("a.obj", "v 0 0 0\nv 1 0 0\nv 1.1 1 0\n" + rest);
  const fs::path second = write_text("b.obj", "v 0 0 0\nv 1 0 0\nv 0.9 1 0\n" + rest);
  ASSERT_NE(MeshFile::open(first).mesh().triangles, MeshFile::open(second).mesh().triangles);
  const Copies copies = read_copies(std::vector{first, second});
  EXPECT_EQ(copies.meshes[1].triangles, copies.meshes[0].triangles);
  EXPECT_EQ(copies.meshes[1].positions[2], Vec3(0.9, 1, 0));
}

TEST_F(CopiesInFiles, ThatDifferAreRefusedByName) {
  const std::string points = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
  const fs::path first = write_text("a.obj", points + "f 1 2 3\nf 1 3 4\n");
  const fs::path more = write_text("b.obj", points + "v 5 5 5\nf 1 2 3\nf 1 3 4\n");
  EXPECT_EQ(refusal(first, more), "b.obj: has 5 points, a.obj 4");
  const fs::path fewer = write_text("c.obj", points + "f 1 2 3\n");
  EXPECT_EQ(refusal(first, fewer), "c.obj: has 1 triangles, a.obj 2");
  const std::string differs =
      " differs from a.obj at triangle 2; copies have the same faces in the same order";
  EXPECT_EQ(refusal(first, write_text("d.obj", points + "f 1 2 3\nf 1 4 3\n")), "d.obj:" + differs);
  // as many points, but other vertices share them
  const std::string corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\n";
  const std::string soup = "f 1 2 3\nf 4 5 6\n";
  const fs::path joined = write_text("e.obj", corners + "v 0 0 0\nv 1 1 0\nv 0 1 0\n" + soup);
  const fs::path apart = write_text("h.obj", corners + "v 0 0 0.1\nv 1 1 0\nv 1 0 0\n" + soup);
  EXPECT_EQ(refusal(first, joined), "");
  EXPECT_EQ(refusal(first, apart), "h.obj:" + differs);
  const fs::path loose = write_text("f.obj", points + "v 0 0 0\nv 0 1 0\nf 2 3 1\n");
  const fs::path lone = write_text("g.obj", points + "f 1 2 3\n");
  EXPECT_EQ(refusal(lone, loose),
            "f.obj: lists its vertices otherwise than g.obj, and points in no triangle cannot be "
            "matched then");
}

TEST_F(CopiesInFiles, AreCombinedAttackedAndWrittenByTheEndingOfTheOutput) {
  const std::vector<Mesh> copies = noisy_copies(3);
  const std::vector<fs::path> paths{write("a.obj", copies[0], FileFormat::Obj),
                                    write("b.stl", copies[1], FileFormat::StlBinary),
                                    write("c.obj", copies[2], FileFormat::Obj)};
  const fs::path out = folder_ / "out.ply";
  const Attack rounding = Attack::parsed("quantise:10");
  const AttackedFile written = collude_files(paths, out, Collusion::Average, rounding, 1);
  EXPECT_EQ(written.points, copies[0].positions.size());
  const MeshFile file = MeshFile::open(out);
  EXPECT_EQ(file.format(), FileFormat::PlyLittle);
  EXPECT_EQ(file.face_count(), copies[0].triangles.size());
  const std::vector<Mesh> read = read_copies(paths).meshes;
  const Mesh expected = quantised(colluded(read, Collusion::Average, 1), 10);
  ASSERT_EQ(file.vertex_count(), expected.positions.size());
  for (std::size_t v = 0; v < file.vertex_count(); ++v) {
    const Vec3& point = file.mesh().positions[file.point_of_vertex()[v]];
    EXPECT_LT((point - expected.positions[v]).norm(), 1e-6);
  }
  EXPECT_NE(reason_of([&] {
              (void)collude_files(paths, paths[2], Collusion::Pick, rounding, 1);
            }).find("c.obj: is a copy itself, which is never overwritten"),
            std::string::npos);
}

}  // namespace
}  // namespace triglyph
