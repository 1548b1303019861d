#include "engine/attack/collusion.h"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "engine/samples/sample_shapes.h"
#include "tests/support/motions.h"

namespace triglyph {
namespace {

std::vector<Mesh> three_copies() {
  const Mesh mesh = make_sample_shape(SampleShape::Closed, 600, 1);
  return {test::shaken(mesh, 0.01, 1), test::shaken(mesh, 0.01, 2), test::shaken(mesh, 0.01, 3)};
}

TEST(Collusion, OfCoordinatesIsWhatItsNameSays) {
  const std::vector<Mesh> copies = three_copies();
  const Mesh average = colluded(copies, collusion_kind("average"), 1);
  const Mesh majority = colluded(copies, collusion_kind("majority"), 1);
  const Mesh minimum = colluded(copies, collusion_kind("minimum"), 1);
  const Mesh maximum = colluded(copies, collusion_kind("maximum"), 1);
  for (std::size_t i = 0; i < average.positions.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::vector<double> values;
      for (const Mesh& copy : copies) values.push_back(copy.positions[i][axis]);
      EXPECT_NEAR(average.positions[i][axis], (values[0] + values[1] + values[2]) / 3, 1e-12);
      std::sort(values.begin(), values.end());
      EXPECT_EQ(minimum.positions[i][axis], values[0]);
      EXPECT_EQ(majority.positions[i][axis], values[1]);
      EXPECT_EQ(maximum.positions[i][axis], values[2]);
    }
  }
}

TEST(Collusion, OfPointsTakesEachFromSomeCopy) {
  const std::vector<Mesh> copies = three_copies();
  for (const char* name : {"pick", "mix"}) {
    const Mesh result = colluded(copies, collusion_kind(name), 4);
    std::vector<std::size_t> taken(copies.size(), 0);
    for (std::size_t i = 0; i < result.positions.size(); ++i) {
      std::size_t from = 0;
      while (from < copies.size() && copies[from].positions[i] != result.positions[i]) ++from;
      ASSERT_LT(from, copies.size()) << name;
      ++taken[from];
    }
    for (const std::size_t count : taken) EXPECT_GT(count, result.positions.size() / 20) << name;
    EXPECT_EQ(colluded(copies, collusion_kind(name), 4).positions, result.positions);
    EXPECT_NE(colluded(copies, collusion_kind(name), 5).positions, result.positions);
  }
}

TEST(Collusion, OfEqualCopiesIsTheCopyHoweverItsPointsAreNumbered) {
  const Mesh mesh = make_sample_shape(SampleShape::Closed, 300, 2);
  Mesh reversed = mesh;
  const auto last = static_cast<std::uint32_t>(mesh.positions.size() - 1);
  std::reverse(reversed.positions.begin(), reversed.positions.end());
  for (Triangle& t : reversed.triangles) {
    for (std::uint32_t& point : t) point = last - point;
  }
  const std::vector<Mesh> copies = {mesh, reversed};
  for (const CollusionKind& kind : collusion_kinds()) {
    EXPECT_EQ(colluded(copies, kind, 1).positions, mesh.positions) << kind.name;
  }
}

TEST(Collusion, OfOtherMeshesIsRefused) {
  std::vector<Mesh> copies = three_copies();
  EXPECT_THROW((void)colluded(std::span(copies).first(1), collusion_kinds()[0], 1), Error);
  std::swap(copies[2].triangles[0], copies[2].triangles[1]);
  try {
    (void)colluded(copies, collusion_kinds()[0], 1);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("copy 3 is connected otherwise"), std::string::npos);
  }
  copies[1].triangles.pop_back();
  EXPECT_THROW((void)colluded(copies, collusion_kinds()[0], 1), Error);
  try {
    (void)collusion_kind("avarage");
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean average"), std::string::npos);
  }
}

}  // namespace
}  // namespace triglyph
