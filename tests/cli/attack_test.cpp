// The verbs attack and survive.
#include <algorithm>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "engine/io/mesh_file.h"
#include "tests/cli/cli_fixture.h"

namespace triglyph {
namespace {

using test::read_all;

class CliAttack : public test::CliTest {
 protected:
  [[nodiscard]] bool exists(const std::string& name) const {
    return std::filesystem::exists(folder_ / name);
  }
};

TEST_F(CliAttack, WritesTheAttackedMeshAndTheSameOneForTheSameSeed) {
  make_sample("a.obj", 2000);
  const test::CliResult first = run("attack simplify:50+noise:0.1 a.obj o/b.obj");
  EXPECT_EQ(first.code, 0) << first.err;
  EXPECT_NE(first.out.find("o/b.obj: simplify:50+noise:0.1, "), std::string::npos) << first.out;
  const double before = double(MeshFile::open(folder_ / "a.obj").face_count());
  EXPECT_NEAR(double(MeshFile::open(folder_ / "o/b.obj").face_count()), before / 2, before / 100);
  EXPECT_EQ(run("attack simplify:50+noise:0.1 a.obj c.obj --seed 1").code, 0);
  EXPECT_EQ(read_all(folder_ / "c.obj"), read_all(folder_ / "o/b.obj"));
  EXPECT_EQ(run("attack simplify:50+noise:0.1 a.obj d.obj --seed 2").code, 0);
  EXPECT_NE(read_all(folder_ / "d.obj"), read_all(folder_ / "o/b.obj"));
}

TEST_F(CliAttack, KeepsTheFormatOrTakesThatOfTheOutputsName) {
  EXPECT_EQ(run("sample --out m --count 1 --triangles 500 --format ply --ascii").code, 0);
  const std::string mesh = "m/0000-closed.ply";
  EXPECT_EQ(run("attack none " + mesh + " b.ply").code, 0);
  EXPECT_EQ(MeshFile::open(folder_ / "b.ply").format(), FileFormat::PlyAscii);
  EXPECT_EQ(MeshFile::open(folder_ / "b.ply").mesh().positions,
            MeshFile::open(folder_ / mesh).mesh().positions);
  EXPECT_EQ(run("attack none " + mesh + " b.stl").code, 0);
  EXPECT_EQ(MeshFile::open(folder_ / "b.stl").format(), FileFormat::StlBinary);
  const test::CliResult digits = run("attack digits:3 " + mesh + " b.off");
  EXPECT_EQ(digits.code, 0) << digits.err;
  EXPECT_EQ(MeshFile::open(folder_ / "b.off").number_step(), 0.01);  // 1.23
}

TEST_F(CliAttack, OfACollectionPutsEachAttackIntoAFolder) {
  make_sample("in/a.obj", 800, 1);
  make_sample("in/deep/b.obj", 800, 2);
  const test::CliResult result =
      run("attack in --attack noise:0.1 --attack flip --attack noise:0.10 --out-dir in/out --json");
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(std::count(result.out.begin(), result.out.end(), '\n'), 4);
  for (const char* name : {"noise-0.1/a.obj", "noise-0.1/deep/b.obj", "flip/a.obj"}) {
    EXPECT_TRUE(exists("in/out/" + std::string(name))) << name;
  }
  const auto line = nlohmann::json::parse(result.out.substr(0, result.out.find('\n')));
  EXPECT_EQ(line["mesh"], "in/a.obj");
  EXPECT_EQ(line["attack"], "noise:0.1");
  EXPECT_EQ(line["status"], "attacked");
  EXPECT_NE(result.err.find("4 meshes: 4 attacked"), std::string::npos) << result.err;
  // what a run before wrote is no input
  EXPECT_NE(run("attack in --attack flip --out-dir in/out").err.find("2 meshes"),
            std::string::npos);
  std::filesystem::resize_file(folder_ / "in/a.obj", 10);
  EXPECT_EQ(run("attack in --protocol leaks --out-dir o --fail-fast").code, 3);
}

TEST_F(CliAttack, OfAWrongCommandSaysWhatIsMeant) {
  make_sample("a.obj", 500);
  const auto refused = [&](const std::string& arguments, const std::string& reason) {
    const test::CliResult result = run(arguments);
    EXPECT_EQ(result.code, 2) << arguments;
    EXPECT_NE(result.err.find(reason), std::string::npos) << result.err;
  };
  refused("attack nosie:0.1 a.obj b.obj", "did you mean noise?");
  refused("attack noise a.obj b.obj", "noise:N needs a number");
  refused("attack noise:0.1 a.obj", "give ATTACK MESH OUT");
  refused("attack a.obj --out-dir o", "give --attack or --protocol");
  refused("attack none a.obj a.obj", "never overwritten");
  refused("attack none a.obj b.txt", "ends in .obj");
  refused("attack none absent.obj b.obj", "absent.obj");
  refused("attack a.obj --protocol everything --out-dir o", "everything");
  EXPECT_FALSE(exists("b.obj"));
}

TEST_F(CliAttack, ColludingWritesOneMeshOfTheCopies) {
  make_sample("clean.obj", 800);
  for (const char* name : {"ada", "ben", "cem"}) {
    const std::string seed = std::to_string(std::string(name).front());
    const std::string copy = name + std::string(name == std::string("ben") ? ".stl" : ".obj");
    ASSERT_EQ(run("attack noise:0.1 clean.obj " + copy + " --seed " + seed).code, 0);
  }
  const std::string copies = "ada.obj ben.stl cem.obj";
  const test::CliResult result = run("attack --collude average " + copies + " --out o/leaked.obj");
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(result.out.rfind("o/leaked.obj: average of 3 copies, ", 0), 0U) << result.out;
  EXPECT_EQ(MeshFile::open(folder_ / "o/leaked.obj").mesh().triangles,
            MeshFile::open(folder_ / "ada.obj").mesh().triangles);
  EXPECT_EQ(run("attack --collude average cem.obj ben.stl ada.obj --out b.obj").code, 0);
  EXPECT_EQ(MeshFile::open(folder_ / "b.obj").mesh().positions,
            MeshFile::open(folder_ / "o/leaked.obj").mesh().positions);
  // attacks follow in the order given, each as often as it is given
  const test::CliResult more =
      run("attack --collude mix " + copies +
          " --out m.ply --attack smooth:2 --attack flip --attack smooth:2 --json");
  EXPECT_EQ(more.code, 0) << more.err;
  const auto line = nlohmann::json::parse(more.out);
  EXPECT_EQ(line["collusion"], "mix");
  EXPECT_EQ(line["copies"], (std::vector<std::string>{"ada.obj", "ben.stl", "cem.obj"}));
  EXPECT_EQ(line["attack"], "smooth:2+flip+smooth:2");
  EXPECT_EQ(MeshFile::open(folder_ / "m.ply").format(), FileFormat::PlyLittle);
}

TEST_F(CliAttack, OfAWrongCollusionSaysWhatIsMeant) {
  make_sample("a.obj", 500, 1);
  make_sample("c.obj", 900, 1);
  ASSERT_EQ(run("attack noise:0.1 a.obj b.obj").code, 0);
  const std::string before = read_all(folder_ / "b.obj");
  const auto refused = [&](const std::string& arguments, const std::string& reason) {
    const test::CliResult result = run("attack --collude " + arguments);
    EXPECT_EQ(result.code, 2) << arguments;
    EXPECT_NE(result.err.find(reason), std::string::npos) << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  };
  refused("avarage a.obj b.obj --out o.obj", "did you mean average?");
  refused("'' a.obj b.obj --out o.obj", "it is one of average, majority");
  refused("average a.obj --out o.obj", "needs two copies or more, not 1");
  refused("average a.obj b.obj", "give --out");
  refused("average a.obj b.obj --out-dir o", "give --out, not --out-dir");
  refused("average a.obj b.obj --out b.obj", "b.obj: is a copy itself, which is never overwritten");
  refused("average a.obj c.obj --out o.obj", "c.obj: has ");
  refused("average a.obj absent.obj --out o.obj", "absent.obj");
  refused("average a.obj b.obj --out o.txt", "ends in .obj");
  refused("average a.obj b.obj --out o.obj --protocol leaks", "alternatives");
  refused("average a.obj b.obj --out o.obj --attack nosie:1", "did you mean noise?");
  EXPECT_NE(run("attack none a.obj o.obj --out o.obj").err.find("--out is of --collude"),
            std::string::npos);
  EXPECT_FALSE(exists("o.obj"));
  EXPECT_EQ(read_all(folder_ / "b.obj"), before);
}

TEST_F(CliAttack, SurvivePrintsATableAndWritesTheSameAsJsonAndCsv) {
  make_sample("a.obj", 6000, 1);
  make_sample("b.obj", 40, 2);
  const std::string command =
      "survive a.obj b.obj --scheme tsq --keys 2 --attack reorder --attack noise:1 ";
  const test::CliResult result = run(command + "--json s.jsonl --csv s.csv --threads 1");
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_NE(result.out.find("reorder                   2/2     0.0   0.0  2^-32\n"),
            std::string::npos)
      << result.out;
  EXPECT_NE(result.out.find("noise:1                   0/2 "), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("tsq: "), std::string::npos) << result.out;  // why b.obj is not marked
  EXPECT_NE(result.out.find("all meshes: "), std::string::npos) << result.out;
  const std::string lines = read_all(folder_ / "s.jsonl");
  const auto first = nlohmann::json::parse(lines.substr(0, lines.find('\n')));
  EXPECT_EQ(first["mesh"], "a.obj");
  EXPECT_EQ(first["marked"], 2);
  EXPECT_GT(first["distortion"]["mrms_rel_diag"], 0);
  EXPECT_EQ(first["attacks"][0]["recovered"], 2);
  EXPECT_EQ(first["attacks"][0]["false_alarm_worst"], 0x1p-32);
  EXPECT_EQ(first["attacks"][1]["recovered"], 0);
  EXPECT_GT(first["attacks"][1]["wrong_bits_median"], 0.25);
  const auto second = nlohmann::json::parse(lines.substr(lines.find('\n') + 1));
  EXPECT_EQ(second["marked"], 0);
  EXPECT_EQ(second["attacks"][0]["tried"], 0);
  const std::string csv = read_all(folder_ / "s.csv");
  EXPECT_EQ(csv.rfind("mesh,scheme,attack,tried,recovered,", 0), 0U);
  EXPECT_NE(csv.find("\na.obj,tsq,reorder,2,2,0,0,"), std::string::npos) << csv;
  EXPECT_NE(csv.find("\nb.obj,tsq,noise:1,0,0,,,,,,,,\n"), std::string::npos) << csv;
  EXPECT_EQ(run(command + "--json t.jsonl --csv t.csv --threads 2").out, result.out);
  EXPECT_EQ(read_all(folder_ / "t.jsonl"), lines);
  EXPECT_EQ(read_all(folder_ / "t.csv"), csv);
}

TEST_F(CliAttack, SurviveTakesTheOptionsOfMarking) {
  make_sample("a.obj", 6000, 1);
  const test::CliResult wide =
      run("survive a.obj --scheme tsq --set redundancy=2 --set message=x --attack none --keys 1");
  EXPECT_EQ(wide.code, 0) << wide.err;
  EXPECT_NE(wide.out, run("survive a.obj --scheme tsq --attack none --keys 1").out);
  EXPECT_NE(run("survive a.obj --set redundncy=2").err.find("did you mean redundancy?"),
            std::string::npos);
  for (const char* wrong : {"--set steps", "--set step=x", "--set fill=true", "--scheme best",
                            "--scheme tsq --set radius=1", "--attack nosie:1", "--keys 0"}) {
    EXPECT_EQ(run("survive a.obj " + std::string(wrong)).code, 2) << wrong;
  }
  EXPECT_EQ(run("survive absent.obj --scheme tsq").code, 3);
}

}  // namespace
}  // namespace triglyph
