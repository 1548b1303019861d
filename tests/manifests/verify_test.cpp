#include <fstream>

#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "engine/base/output_file.h"
#include "engine/io/export_mesh.h"
#include "engine/io/mesh_file.h"
#include "engine/marking/verify_file.h"
#include "engine/mesh/edge_length.h"
#include "manifests/run.h"
#include "tests/support/attacks.h"
#include "tests/support/shapes.h"
#include "tests/support/temp_folder.h"

namespace triglyph {
namespace {

namespace fs = std::filesystem;

void save(const Mesh& mesh, const fs::path& path) {
  OutputFile file(path);
  file.write(export_mesh(mesh, {}));
  file.commit();
}

// One mesh, marked and recorded.
class RecordedMesh {
 public:
  explicit RecordedMesh(const OptionValues& settings, const Mesh& mesh = test::bumpy_ball().mesh) {
    save(mesh, folder_ / "in.obj");
    MeshList jobs({{folder_ / "in.obj", folder_.path()}}, settings, folder_ / "out");
    const std::atomic<bool> stop{false};
    run_jobs(jobs, Key::trial(), {},
             {.delivered = [&](const Record& record) { line_ = to_json(record).dump(); }}, stop);
  }
  [[nodiscard]] MarkedFile record() const { return parse_record(line_).file; }
  [[nodiscard]] const std::string& line() const { return line_; }
  [[nodiscard]] fs::path original() const { return folder_ / "in.obj"; }

  // The vertices that were moved: those near one place, by a tenth of an edge or so.
  std::vector<std::uint64_t> dent() const {
    const MeshFile file = MeshFile::open(record().out);
    std::vector<Vec3> positions = file.mesh().positions;
    const Vec3 place = positions[positions.size() / 2];
    const double edge = mean_edge_length(file.mesh());
    std::vector<std::uint64_t> dented;
    const auto points = file.point_of_vertex();
    for (std::uint64_t vertex = 0; vertex < points.size(); ++vertex) {
      Vec3& p = positions[points[vertex]];
      if ((p - place).norm() > 6 * edge) continue;
      p += Vec3(0.3, -0.2, 0.25) * edge * std::sin(static_cast<double>(7 * vertex));
      dented.push_back(vertex);
    }
    const std::vector<char> bytes = file.patched(positions);
    OutputFile out(record().out);
    out.write(bytes);
    out.commit();
    return dented;
  }

 private:
  test::TempFolder folder_;
  std::string line_;
};

OptionValues message_settings() {
  return {{"message", std::string("verify")}};
}

TEST(VerifyFile, TellsIntactAlteredLostAndMissingApart) {
  const RecordedMesh marked(message_settings());
  const MarkedFile mark = marked.record();
  EXPECT_EQ(verify_file(mark, Key::trial()).verdict, FileVerdict::Intact);
  EXPECT_EQ(verify_file(mark, Key::generate()).verdict, FileVerdict::Lost);

  const std::string bytes = test::read_all(mark.out);
  std::ofstream(mark.out, std::ios::app) << "# a comment\n";
  EXPECT_EQ(verify_file(mark, Key::trial()).verdict, FileVerdict::Altered);
  std::ofstream(mark.out) << bytes.substr(0, bytes.size() / 3) << "\nv 1 2\n";
  EXPECT_EQ(verify_file(mark, Key::trial()).verdict, FileVerdict::Damaged);
  fs::copy_file(marked.original(), mark.out, fs::copy_options::overwrite_existing);
  EXPECT_EQ(verify_file(mark, Key::trial()).verdict, FileVerdict::Lost);
  fs::remove(mark.out);
  EXPECT_EQ(verify_file(mark, Key::trial()).verdict, FileVerdict::Missing);
  MarkedFile bad = mark;
  bad.status = FileStatus::TooSmall;
  EXPECT_EQ(verify_file(bad, Key::trial()).verdict, FileVerdict::NotMarked);
}

TEST(VerifyFile, KnowsAFilledMesh) {
  OptionValues settings;
  settings["fill"] = true;
  const RecordedMesh marked(settings);
  const MarkedFile mark = marked.record();
  ASSERT_EQ(mark.status, FileStatus::Marked);
  const Verification found = verify_file(mark, Key::trial());
  EXPECT_EQ(found.verdict, FileVerdict::Intact);
  EXPECT_GE(found.units_found, mark.units_embedded);
}

class EverySchemesDamage : public testing::TestWithParam<std::string> {};

TEST_P(EverySchemesDamage, IsLocated) {
  OptionValues settings;
  settings["scheme"] = GetParam();
  settings["fill"] = true;
  settings["detail"] = true;
  const RecordedMesh marked(settings);
  const MarkedFile mark = marked.record();
  ASSERT_EQ(mark.status, FileStatus::Marked);
  ASSERT_TRUE(mark.units);
  EXPECT_EQ(mark.units->size(), mark.units_embedded);
  const Verification before = verify_file(mark, Key::trial(), true);
  ASSERT_TRUE(before.damage);
  EXPECT_EQ(before.damage->units_expected, mark.units_embedded);
  EXPECT_EQ(before.damage->units_damaged, 0U);
  EXPECT_TRUE(before.damage->vertices.empty());
  EXPECT_FALSE(verify_file(mark, Key::generate(), true).damage);

  const std::vector<std::uint64_t> dented = marked.dent();
  ASSERT_GT(dented.size(), 50U);
  const Verification after = verify_file(mark, Key::trial(), true);
  EXPECT_EQ(after.verdict, FileVerdict::Altered);
  ASSERT_TRUE(after.damage);
  EXPECT_GT(after.damage->units_damaged, 0U);
  EXPECT_LT(after.damage->units_damaged, after.damage->units_expected / 4);
  EXPECT_EQ(after.units_found, after.damage->units_expected - after.damage->units_damaged);
  const Verification brief = verify_file(mark, Key::trial());
  EXPECT_EQ(brief.units_found, after.units_found);
  EXPECT_TRUE(brief.damage->vertices.empty());
  const auto& named = after.damage->vertices;
  EXPECT_TRUE(std::is_sorted(named.begin(), named.end()));
  std::vector<std::uint64_t> both;
  std::set_intersection(named.begin(), named.end(), dented.begin(), dented.end(),
                        std::back_inserter(both));
  EXPECT_GE(both.size() * 2, dented.size());   // most of what was dented is named
  EXPECT_LE(named.size(), 4 * dented.size());  // and little else
}

TEST_P(EverySchemesDamage, IsNotGuessedInAMeshOfAnotherOrder) {
  OptionValues settings;
  settings["scheme"] = GetParam();
  settings["fill"] = true;
  settings["detail"] = true;
  const RecordedMesh marked(settings);
  const MarkedFile mark = marked.record();
  save(test::shuffled(MeshFile::open(mark.out).mesh(), 3), mark.out);
  const Verification found = verify_file(mark, Key::trial(), true);
  EXPECT_EQ(found.verdict, FileVerdict::Altered);
  EXPECT_FALSE(found.damage);
  save(test::cropped_half(MeshFile::open(mark.out).mesh(), 3), mark.out);
  EXPECT_FALSE(verify_file(mark, Key::trial(), true).damage);
}

INSTANTIATE_TEST_SUITE_P(All, EverySchemesDamage, testing::Values("tsq", "aie", "iie"),
                         [](const auto& param) { return param.param; });

TEST(Records, NameUnitsOnlyIfWanted) {
  OptionValues settings = message_settings();
  EXPECT_FALSE(RecordedMesh(settings).record().units);
  settings["detail"] = true;
  const RecordedMesh detailed(settings);
  ASSERT_TRUE(detailed.record().units);
  EXPECT_EQ(detailed.record().units->size(), detailed.record().units_embedded);
  settings["detail"] = false;
  settings["scheme"] = std::string("iie");
  settings.erase("message");
  settings["fill"] = true;
  EXPECT_TRUE(RecordedMesh(settings).record().units);

  auto json = nlohmann::ordered_json::parse(detailed.line());
  json["units"][0][1] = 1000;  // no such part
  EXPECT_THROW((void)parse_record(json.dump()), Error);
  json["units"] = {{5, 0}, {5, 1}};  // anchors must ascend
  EXPECT_THROW((void)parse_record(json.dump()), Error);
  json["units"] = "none";
  EXPECT_THROW((void)parse_record(json.dump()), Error);
}

}  // namespace
}  // namespace triglyph
