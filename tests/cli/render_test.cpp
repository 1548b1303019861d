// triglyph render and mark --render, through the executables.
#include <cstdlib>
#include <filesystem>

#include <gtest/gtest.h>
#include <sys/wait.h>

#include "engine/base/output_file.h"
#include "engine/io/export_mesh.h"
#include "engine/samples/sample_shapes.h"
#include "tests/support/temp_folder.h"

namespace triglyph {
namespace {

namespace fs = std::filesystem;

class CliRender : public testing::Test {
 protected:
  CliRender() {
    for (const char* name : {"a.obj", "b.obj"}) {
      OutputFile file(folder_ / name);
      file.write(export_mesh(make_sample_shape(SampleShape::Closed, 3000, 1), {}));
      file.commit();
    }
  }

  // The exit code; messages are left in .err.
  int run(const std::string& command) const {
    const int status = std::system(
        ("cd '" + folder_.path().string() + "' && " + command + " >.out 2>.err").c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128;
  }
  int triglyph(const std::string& arguments) const {
    return run("'" TRIGLYPH_EXECUTABLE "' " + arguments + " </dev/null");
  }
  [[nodiscard]] std::string message() const { return test::read_all(folder_ / ".err"); }
  [[nodiscard]] bool is_png(const std::string& name) const {
    return test::read_all(folder_ / name).rfind("\x89PNG", 0) == 0;
  }

  test::TempFolder folder_;
};

TEST_F(CliRender, DrawsPairsAndTurntables) {
  ASSERT_EQ(triglyph("mark --message x a.obj --out o"), 0);
  ASSERT_EQ(triglyph("render a.obj o/a.obj --out pics/pair.png --width 100"), 0) << message();
  EXPECT_TRUE(is_png("pics/pair.png"));
  ASSERT_EQ(triglyph("render a.obj --out t.png --width 100 --turntable 3"), 0) << message();
  for (const char* name : {"t-000.png", "t-001.png", "t-002.png"}) EXPECT_TRUE(is_png(name));
  EXPECT_NE(test::read_all(folder_ / "t-000.png"), test::read_all(folder_ / "t-001.png"));
  ASSERT_EQ(triglyph("render a.obj --out 1.png --width 100 --threads 1"), 0);
  ASSERT_EQ(triglyph("render a.obj --out 2.png --width 100 --threads 2"), 0);
  EXPECT_EQ(test::read_all(folder_ / "1.png"), test::read_all(folder_ / "2.png"));
}

TEST_F(CliRender, DrawsThePapersFigure) {
  ASSERT_EQ(triglyph("render a.obj --paper-figure aie --out f.png --width 100"), 0) << message();
  EXPECT_TRUE(is_png("f.png"));
}

TEST_F(CliRender, RefusesInOneLine) {
  folder_.write("empty.obj", "v 0 0 0\n");
  folder_.write("file", "");
  for (const char* wrong :
       {"render", "render a.obj", "render --out x.png", "render absent.obj --out x.png",
        "render empty.obj --out x.png", "render a.obj --out x.gif", "render a.obj --out x",
        "render a.obj --out x.png --view up", "render a.obj --out x.png --panels beauty",
        "render a.obj --out x.png --background pink", "render a.obj --out x.png --width 1",
        "render a.obj --out x.png --panels original --paper-figure tsq"}) {
    EXPECT_EQ(triglyph(wrong), 2) << wrong;
    EXPECT_FALSE(message().empty()) << wrong;
  }
  EXPECT_EQ(triglyph("render a.obj --out file/x.png"), 1);
  EXPECT_NE(message().find("file/x.png"), std::string::npos) << message();
  EXPECT_FALSE(fs::exists(folder_ / "x.png"));
}

TEST_F(CliRender, SaysSoIfTheRendererIsMissing) {
  fs::create_directory(folder_ / "alone");
  fs::copy_file(TRIGLYPH_EXECUTABLE, folder_ / "alone" / "triglyph");
  EXPECT_EQ(run("PATH=/nowhere alone/triglyph render a.obj --out x.png"), 2);
  EXPECT_NE(message().find("triglyph-render"), std::string::npos);
  EXPECT_EQ(run("PATH=/nowhere alone/triglyph mark a.obj --out o --render p"), 2);
  EXPECT_FALSE(fs::exists(folder_ / "o"));
}

TEST_F(CliRender, DrawsEveryMeshThatARunMarks) {
  folder_.write("tiny.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_EQ(triglyph("mark --message x a.obj tiny.obj b.obj --out o --render p/q"), 3);
  EXPECT_TRUE(is_png("p/q/a.obj.png")) << message();
  EXPECT_TRUE(is_png("p/q/b.obj.png"));
  EXPECT_FALSE(fs::exists(folder_ / "p/q/tiny.obj.png"));
}

TEST_F(CliRender, OfARunReportsPicturesThatCannotBe) {
  folder_.write("p", "a file where the folder should be");
  EXPECT_EQ(triglyph("mark --message x a.obj --out o --render p"), 3);
  EXPECT_NE(message().find("not all pictures were drawn"), std::string::npos) << message();
  EXPECT_TRUE(fs::exists(folder_ / "o/a.obj"));
}

TEST_F(CliRender, GoesOnAfterABadLineOfABatch) {
  folder_.write("batch.jsonl",
                "nonsense\n"
                "{\"original\": \"a.obj\", \"marked\": \"absent.obj\", \"out\": \"1.png\"}\n"
                "{\"original\": \"a.obj\", \"marked\": \"b.obj\", \"out\": \"2.png\"}\n");
  EXPECT_EQ(run("'" TRIGLYPH_EXECUTABLE "' render --batch --width 100 <batch.jsonl"), 3);
  EXPECT_NE(message().find("line 1"), std::string::npos);
  EXPECT_NE(message().find("absent.obj"), std::string::npos);
  EXPECT_TRUE(is_png("2.png"));
}

TEST_F(CliRender, DrawsEveryPairOfFoldersAndRecords) {
  fs::create_directories(folder_ / "in/sub");
  fs::rename(folder_ / "a.obj", folder_ / "in/a.obj");
  fs::rename(folder_ / "b.obj", folder_ / "in/sub/b.obj");
  ASSERT_EQ(triglyph("mark in --message m --out o --records r.jsonl"), 0) << message();
  EXPECT_EQ(triglyph("render in o --out p --width 64 --samples 1"), 0);
  EXPECT_TRUE(fs::exists(folder_ / "p/a.obj.png"));
  EXPECT_TRUE(fs::exists(folder_ / "p/sub/b.obj.png"));
  EXPECT_EQ(triglyph("render r.jsonl --out q --width 64 --samples 1 --ledger o.ledger"), 0);
  EXPECT_EQ(triglyph("ledger runs o.ledger"), 0);
  EXPECT_NE(test::read_all(folder_ / ".out").find("\"verb\":\"render\""), std::string::npos);
  EXPECT_TRUE(fs::exists(folder_ / "q/o/sub/b.obj.png"));
  EXPECT_EQ(triglyph("render in o --out t --width 64 --samples 1 --turntable 2"), 0) << message();
  EXPECT_TRUE(fs::exists(folder_ / "t/a.obj-001.png"));
  fs::remove(folder_ / "o/a.obj");
  EXPECT_EQ(triglyph("render in o --out p --width 64 --samples 1"), 3);
  EXPECT_NE(message().find("2 pairs: 1 drawn, 1 failed"), std::string::npos) << message();
  EXPECT_EQ(triglyph("render in o --width 64"), 2);  // no --out
}

}  // namespace
}  // namespace triglyph
