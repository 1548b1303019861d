// triglyph render and mark --render, through the executables.
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>
#include <unistd.h>

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
  // Waits until there is no such process.
  [[nodiscard]] static bool ends(pid_t process) {
    for (int i = 0; i < 1000; ++i) {
      if (kill(process, 0) != 0) return true;
      usleep(10000);
    }
    return false;
  }
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

// What triglyph says to a renderer that fails, with a script in its place: it draws by writing the
// name of the mesh, and does what the mesh's name says.
class CliRenderRun : public CliRender {
 protected:
  CliRenderRun() {
    fs::create_directory(folder_ / "bin");
    fs::copy_file(TRIGLYPH_EXECUTABLE, folder_ / "bin/triglyph");
    folder_.write("bin/triglyph-render", R"sh(#!/bin/bash
[[ $* == *--bad* ]] && { echo 'no such option' >&2; exit 2; }
echo "$*" >>started
echo '{}'
while IFS= read -r line; do
  mesh=$(sed 's/.*"original":"\([^"]*\)".*/\1/' <<<"$line")
  picture=$(sed 's/.*"out":"\([^"]*\)".*/\1/' <<<"$line")
  case $mesh in
    *crash*) kill -SEGV $$ ;;
    *killed*) kill -KILL $$ ;;
    *exit*) exit 7 ;;
    *hang*) echo $$ >hanging; exec sleep 100 ;;
    *nonsense*) echo nonsense; continue ;;
    *bad*) echo '{"status": "malformed", "error": "'"$mesh"': is bad"}'; continue ;;
  esac
  mkdir -p "$(dirname "$picture")"
  echo "$mesh" >"$picture"
  echo '{}'
done
)sh");
    fs::permissions(folder_ / "bin/triglyph-render", fs::perms::owner_all);
  }

  void make_pairs(const std::vector<std::string>& names) const {
    for (const std::string& name : names) {
      folder_.write("in/" + name, "v 0 0 0\n");
      folder_.write("o/" + name, "v 0 0 0\n");
    }
  }
  int render(const std::string& arguments, const std::string& environment = "") const {
    return run(environment + " bin/triglyph render in o --out p " + arguments + " </dev/null");
  }
  [[nodiscard]] std::vector<nlohmann::json> lines() const {
    std::vector<nlohmann::json> all;
    std::istringstream text(test::read_all(folder_ / ".out"));
    for (std::string line; std::getline(text, line);) all.push_back(nlohmann::json::parse(line));
    return all;
  }
  // The statuses of the pairs, in their order.
  [[nodiscard]] std::vector<std::string> statuses() const {
    std::vector<std::string> all;
    for (const auto& line : lines()) all.push_back(line.at("status"));
    return all;
  }
  [[nodiscard]] std::size_t pictures() const {
    const auto files = fs::directory_iterator(folder_ / "p");
    return static_cast<std::size_t>(std::distance(begin(files), end(files)));
  }
};

TEST_F(CliRenderRun, APictureThatKillsItsRendererCostsOneRecord) {
  make_pairs({"0.obj", "1.obj", "2crash.obj", "3.obj", "4exit.obj", "5nonsense.obj", "6bad.obj",
              "7.obj", "8killed.obj", "9.obj"});
  for (const char* threads : {"1", "3"}) {
    fs::remove_all(folder_ / "p");
    EXPECT_EQ(render(std::string("--json --threads ") + threads), 3) << message();
    EXPECT_EQ(statuses(),
              (std::vector<std::string>{"drawn", "drawn", "crashed", "drawn", "crashed", "crashed",
                                        "malformed", "drawn", "crashed", "drawn"}))
        << message();
    EXPECT_EQ(pictures(), 5U);
    EXPECT_NE(message().find("in/2crash.obj: killed the renderer by signal 11"), std::string::npos)
        << message();
    EXPECT_NE(message().find("in/4exit.obj: ended the renderer with exit code 7"),
              std::string::npos);
    EXPECT_NE(message().find("in/6bad.obj: is bad"), std::string::npos);
    EXPECT_NE(message().find("in/8killed.obj: killed the process by signal 9"), std::string::npos);
    EXPECT_NE(message().find("10 pairs: 5 drawn, 5 failed"), std::string::npos);
  }
  EXPECT_EQ(lines()[3]["picture"], "p/3.obj.png");
}

// A crash of the worker itself is the supervisor's business, as in every run.
TEST_F(CliRenderRun, SurvivesACrashOfTheWorker) {
  make_pairs({"0.obj", "1.obj", "2.obj", "3.obj"});
  EXPECT_EQ(render("--json", "TRIGLYPH_FAULT='crash 2.obj'"), 3);
  EXPECT_EQ(statuses(), (std::vector<std::string>{"drawn", "drawn", "crashed", "drawn"}));
}

TEST_F(CliRenderRun, APictureThatTakesTooLongCostsOneRecord) {
  make_pairs({"0.obj", "1hang.obj", "2.obj"});
  EXPECT_EQ(render("--json --timeout 1 --threads 1"), 3);
  EXPECT_EQ(statuses(), (std::vector<std::string>{"drawn", "too slow", "drawn"})) << message();
  // the renderer went with the worker
  const int hanging = std::stoi(test::read_all(folder_ / "hanging"));
  EXPECT_TRUE(ends(hanging));
}

TEST_F(CliRenderRun, AnInterruptEndsTheRunAndItsRenderers) {
  make_pairs({"0.obj", "1hang.obj", "2.obj"});
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(run("timeout --signal=INT 1 bin/triglyph render in o --out p --json --threads 1"), 124);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));
  EXPECT_EQ(statuses(), std::vector<std::string>{"drawn"});
  EXPECT_TRUE(ends(std::stoi(test::read_all(folder_ / "hanging"))));
  EXPECT_EQ(run("timeout --preserve-status --signal=INT 1 bin/triglyph render in o --out p"), 130);
}

TEST_F(CliRenderRun, HasTheOptionsOfARun) {
  make_pairs({"0.obj", "1bad.obj", "2bad.obj", "3bad.obj", "4bad.obj", "5.obj"});
  EXPECT_EQ(render("--threads 1 --fail-fast --json"), 3);
  EXPECT_NE(message().find("given up after 1 failures"), std::string::npos) << message();
  EXPECT_LT(lines().size(), 6U);
  EXPECT_EQ(render("--max-failures 2 --threads 1 --json"), 3);
  EXPECT_NE(message().find("given up after 3 failures"), std::string::npos) << message();
  EXPECT_EQ(render("--quiet"), 3);
  EXPECT_EQ(message().find("pairs"), std::string::npos);
  EXPECT_NE(message().find("in/1bad.obj: is bad"), std::string::npos);
  EXPECT_EQ(test::read_all(folder_ / ".out"), "");
  EXPECT_EQ(render("--ledger l"), 3);
  EXPECT_EQ(run("bin/triglyph ledger results l"), 0);
  ASSERT_EQ(lines().size(), 6U);
  EXPECT_EQ(lines()[1]["status"], "malformed");
  EXPECT_EQ(lines()[5]["status"], "drawn");
  EXPECT_EQ(render("--width 7 --view=-30,10"), 3);  // the renderer's own options are passed on
  EXPECT_NE(test::read_all(folder_ / "started").find("--width 7 --view=-30,10"), std::string::npos);
}

TEST_F(CliRenderRun, MistakesEndItBeforeTheFirstPicture) {
  make_pairs({"0.obj"});
  for (const char* wrong : {"--bad", "--timeout x", "--max-failures x", "--threads 0"}) {
    EXPECT_EQ(render(wrong), 2) << wrong;
    EXPECT_FALSE(message().empty()) << wrong;
    EXPECT_FALSE(fs::exists(folder_ / "p")) << wrong;
  }
  fs::remove(folder_ / "bin/triglyph-render");
  EXPECT_EQ(render("", "PATH=/usr/bin:/bin"), 2);
  EXPECT_NE(message().find("triglyph-render"), std::string::npos);
}

// The real renderer says what is wrong with its options before it says that it can begin.
TEST_F(CliRender, OfACollectionRefusesOptionsBeforeTheFirstPicture) {
  fs::create_directory(folder_ / "in");
  fs::rename(folder_ / "a.obj", folder_ / "in/a.obj");
  for (const char* wrong : {"--view up", "--width 1", "--samples 0", "--background pink",
                            "--panels beauty", "--frobnicate"}) {
    EXPECT_EQ(triglyph(std::string("render in in --out p ") + wrong), 2) << wrong;
    EXPECT_FALSE(message().empty()) << wrong;
    EXPECT_FALSE(fs::exists(folder_ / "p")) << wrong;
  }
}

// A collection is drawn by a run, which has options that the renderer does not.
TEST_F(CliRender, HelpNamesTheOptionsOfARun) {
  for (const char* command : {"render --help", "render . . --help"}) {
    ASSERT_EQ(triglyph(command), 0);
    for (const char* option : {"--json", "--memory", "--timeout", "--max-failures", "--fail-fast",
                               "--quiet", "--ledger", "--panels"}) {
      EXPECT_NE(test::read_all(folder_ / ".out").find(option), std::string::npos) << option;
    }
  }
}

TEST_F(CliRender, DrawsTheSamePicturesInARunAsAlone) {
  fs::create_directories(folder_ / "in");
  for (const char* name : {"0.obj", "1.obj", "2.obj", "3.obj"}) {
    fs::copy_file(folder_ / "a.obj", folder_ / "in" / name);
  }
  ASSERT_EQ(triglyph("mark in --message m --out o"), 0) << message();
  ASSERT_EQ(triglyph("render in o --out p --width 64 --samples 2"), 0) << message();
  ASSERT_EQ(triglyph("render in/2.obj o/2.obj --out 2.png --width 64 --samples 2"), 0);
  const std::string alone = test::read_all(folder_ / "2.png");
  EXPECT_EQ(test::read_all(folder_ / "p/2.obj.png"), alone);
  fs::remove(folder_ / "p/2.obj.png");
  ASSERT_EQ(triglyph("render in o --out p --width 64 --samples 2 --threads 1"), 0);
  EXPECT_EQ(test::read_all(folder_ / "p/2.obj.png"), alone);
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
