// Marking of files: what depends on their numbers and faces.
#include "engine/marking/mark_file.h"

#include <cmath>
#include <fstream>

#include <gtest/gtest.h>

#include "engine/base/random.h"
#include "engine/marking/read_file.h"
#include "engine/samples/sample_shapes.h"
#include "tests/support/shapes.h"
#include "tests/support/temp_folder.h"

namespace triglyph {
namespace {

const Message kHidden{'f', 'i', 'l', 'e', 's'};

MarkRequest request_of(OptionValues values) {
  values.emplace("message", std::string(kHidden.begin(), kHidden.end()));
  return resolve(values);
}

std::optional<Message> message_read(const std::filesystem::path& path) {
  const FileReading reading = read_file(path, encodings_of({}), std::vector<Key>{Key::trial()});
  return reading.mark ? std::optional(reading.mark->message) : std::nullopt;
}

// Writes a mesh with so many decimals.
std::string obj_of(const Mesh& mesh, int decimals) {
  std::string text;
  char line[128];
  for (const Vec3& p : mesh.positions) {
    std::snprintf(line, sizeof(line), "v %.*f %.*f %.*f\n", decimals, p[0], decimals, p[1],
                  decimals, p[2]);
    text += line;
  }
  for (const Triangle& t : mesh.triangles) {
    std::snprintf(line, sizeof(line), "f %u %u %u\n", t[0] + 1, t[1] + 1, t[2] + 1);
    text += line;
  }
  return text;
}

// A bumpy torus of quadrangles, whose diagonals are nearly equal.
std::string quadrangles() {
  constexpr std::uint32_t kAround = 120, kAlong = 60;
  std::string text;
  char line[128];
  for (std::uint32_t i = 0; i < kAround; ++i) {
    for (std::uint32_t j = 0; j < kAlong; ++j) {
      const double a = 2 * M_PI * i / kAround, b = 2 * M_PI * j / kAlong;
      const double tube =
          0.5 + 0.08 * std::sin(3 * a) + 0.05 * std::cos(2 * b + a) + 0.002 * random_unit(1, i, j);
      const double out = 1.4 + 0.2 * std::cos(a) + tube * std::cos(b);
      std::snprintf(line, sizeof(line), "v %.7f %.7f %.7f\n", 1.3 * out * std::cos(a),
                    out * std::sin(a), 0.9 * tube * std::sin(b));
      text += line;
    }
  }
  for (std::uint32_t i = 0; i < kAround; ++i) {
    for (std::uint32_t j = 0; j < kAlong; ++j) {
      const std::uint32_t k = (i + 1) % kAround, l = (j + 1) % kAlong;
      std::snprintf(line, sizeof(line), "f %u %u %u %u\n", i * kAlong + j + 1, k * kAlong + j + 1,
                    k * kAlong + l + 1, i * kAlong + l + 1);
      text += line;
    }
  }
  return text;
}

TEST(MarkFile, ADigitMoreIsUsedWhereTheFileHasTooFew) {
  const test::TempFolder folder;
  const Mesh& ball = test::bumpy_ball().mesh;
  folder.write("in.obj", obj_of(ball, 3));
  const auto marked = [&](OptionValues values, const char* out) {
    values.emplace("scheme", std::string("tsq"));
    return mark_file(folder / "in.obj", folder / out, request_of(values), Key::trial());
  };
  const MarkedFile none = marked({{"digits", std::int64_t{0}}}, "none.obj");
  ASSERT_EQ(none.status, FileStatus::TooCoarse);
  EXPECT_NE(none.error.find("--digits 1"), std::string::npos) << none.error;
  const MarkedFile one = marked({}, "one.obj");
  ASSERT_TRUE(one.is_marked()) << one.error;
  EXPECT_EQ(one.digits, 1);
  EXPECT_EQ(message_read(folder / "one.obj"), kHidden);
  // coordinates that do not move keep their text
  std::ifstream before(folder / "in.obj"), after(folder / "one.obj");
  std::string old_token, new_token;
  std::size_t changed = 0, longer = 0;
  while (before >> old_token && after >> new_token) {
    if (old_token == new_token) continue;
    ++changed;
    longer += new_token.size() > old_token.size();
    EXPECT_NEAR(std::stod(old_token), std::stod(new_token), 0.1);
  }
  EXPECT_GT(changed, 0U);
  EXPECT_GT(longer, changed / 2);
  folder.write("in.obj", obj_of(ball, 7));
  EXPECT_EQ(marked({}, "fine.obj").digits, 0);
  EXPECT_EQ(marked({{"digits", std::int64_t{2}}}, "finer.obj").digits, 2);
}

// A coarse mesh, on which wide cells would move points too far, gets those of a normal mark.
TEST(MarkFile, AStrongMarkOfACoarseMeshHasTheUsualCells) {
  const test::TempFolder folder;
  folder.write("in.obj", obj_of(make_sample_shape(SampleShape::Closed, 900, 301), 6));
  const auto marked = [&](const char* strength) {
    return mark_file(
        folder / "in.obj", folder / (std::string(strength) + ".obj"),
        request_of({{"scheme", std::string("tsq")}, {"strength", std::string(strength)}}),
        Key::trial());
  };
  const MarkedFile normal = marked("normal");
  const MarkedFile strong = marked("strong");
  ASSERT_TRUE(normal.is_marked()) << normal.error;
  ASSERT_TRUE(strong.is_marked()) << strong.error;
  EXPECT_EQ(strong.encoding(), normal.encoding());
  EXPECT_GT(strong.units_embedded, normal.units_embedded);
  EXPECT_EQ(message_read(folder / "strong.obj"), kHidden);
}

TEST(MarkFile, QuadranglesWithNearlyEqualDiagonalsCarryEveryLayer) {
  const test::TempFolder folder;
  folder.write("in.obj", quadrangles());
  for (const char* scheme : {"tsq", "aie", "flux+tsq", "flux+aie"}) {
    const std::string out = std::string(scheme) + ".obj";
    const MarkedFile file = mark_file(folder / "in.obj", folder / out,
                                      request_of({{"scheme", std::string(scheme)}}), Key::trial());
    ASSERT_TRUE(file.is_marked()) << file.error;
    EXPECT_GT(file.units_embedded, 0.8 * file.units_assigned) << scheme;
    const std::string units = std::string(scheme).substr(std::string(scheme).find('+') + 1);
    const FileReading reading =
        read_file(folder / out, encodings_of({{"scheme", units}}), std::vector<Key>{Key::trial()});
    ASSERT_TRUE(reading.mark) << scheme;
    EXPECT_EQ(reading.mark->message, kHidden);
  }
}

}  // namespace
}  // namespace triglyph
