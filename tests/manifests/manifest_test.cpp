#include "manifests/manifest.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include "engine/base/error.h"
#include "engine/scheme/registry.h"
#include "tests/support/temp_folder.h"

namespace triglyph {
namespace {

namespace fs = std::filesystem;

std::vector<Job> jobs_of(JobSource& source) {
  std::vector<Job> jobs;
  while (auto job = source.next()) jobs.push_back(std::move(*job));
  return jobs;
}

std::vector<Job> jobs_of(const fs::path& manifest, const fs::path& out = "") {
  ManifestReader reader(manifest, {{"message", std::string("any")}}, out);
  return jobs_of(reader);
}

std::string error_of(const fs::path& manifest, const fs::path& out = "") {
  try {
    jobs_of(manifest, out);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Manifest, LinesOverrideDefaultsOverrideOptions) {
  const test::TempFolder folder;
  const auto manifest = folder.write(
      "m.jsonl",
      "{\"triglyph\": 1, \"defaults\": {\"message\": \"all\", \"redundancy\": 7, \"out\": "
      "\"o/\"}}\n"
      "\n"
      "{\"mesh\": \"a/b.obj\"}\r\n"
      "{\"mesh\": \"c.ply\", \"message_hex\": \"00ff\", \"out\": \"x.ply\", \"step\": 0.05,"
      " \"layout\": \"first-fit\", \"assign\": \"sum\", \"cost\": \"rms\", \"scheme\": \"tsq\","
      " \"marker_bits\": 4, \"subscript_bits\": 9, \"part_bits\": 16}\n"
      "{\"mesh\": \"d.stl\", \"fill\": true}");
  const auto jobs = jobs_of(manifest);
  ASSERT_EQ(jobs.size(), 3U);
  EXPECT_EQ(jobs[0].mesh, folder / "a/b.obj");
  EXPECT_EQ(jobs[0].out, folder / "o/a/b.obj");
  EXPECT_EQ(jobs[0].request.message(), (Message{'a', 'l', 'l'}));
  EXPECT_EQ(jobs[0].request.options.redundancy, 7U);
  EXPECT_EQ(jobs[1].out, folder / "x.ply");
  EXPECT_EQ(jobs[1].request.message(), (Message{0, 255}));
  EXPECT_EQ(jobs[1].request.options.scheme_options.at("step"), OptionValue(0.05));
  EXPECT_EQ(jobs[1].request.options.layout.method, LayoutMethod::FirstFit);
  EXPECT_EQ(jobs[1].request.options.assign, AssignMethod::Sum);
  EXPECT_EQ(jobs[1].request.options.cost, CostFunction::Rms);
  EXPECT_EQ(jobs[1].request.options.format, (WordFormat{4, 9, 16}));
  EXPECT_TRUE(jobs[2].request.is_fill());
  EXPECT_EQ(jobs[2].request.options.scheme_options,
            scheme_info("tsq").defaults(true, Strength::Normal).options);
  EXPECT_EQ(jobs[2].index, 2U);
}

TEST(Manifest, GlobsAreSortedAndKeepTheirFolders) {
  const test::TempFolder folder;
  for (const char* name : {"in/b.obj", "in/a.obj", "in/deep/er/c.obj", "in/d.ply", "in/.h.obj"}) {
    folder.write(name, "");
  }
  const auto names_of = [&](const std::string& pattern) {
    std::string names;
    const auto manifest = folder.write("m.jsonl", "{\"mesh\": \"" + pattern + "\"}");
    for (const Job& job : jobs_of(manifest, folder / "out")) {
      names += job.out.lexically_relative(folder / "out").string() + " ";
    }
    return names;
  };
  EXPECT_EQ(names_of("in/*.obj"), "a.obj b.obj ");
  EXPECT_EQ(names_of("in/**/*.obj"), "a.obj b.obj deep/er/c.obj ");
  EXPECT_EQ(names_of("in/**/e[a-z]/?.obj"), "deep/er/c.obj ");
  EXPECT_EQ(names_of("in/d.ply"), "in/d.ply ");
}

// A folder in which nothing can match is not looked into; one in which something may must be read.
TEST(Manifest, GlobsLeaveNoFolderOutInSilence) {
  if (geteuid() == 0) GTEST_SKIP() << "root may read every folder";
  const test::TempFolder folder;
  folder.write("a/b.obj", "");
  folder.write("closed/c.obj", "");
  fs::permissions(folder / "closed", fs::perms::none);
  EXPECT_EQ(expand_glob(folder / "a/*.obj").size(), 1U);
  EXPECT_EQ(expand_glob(folder / "*.obj").size(), 0U);
  EXPECT_THROW((void)expand_glob(folder / "*/*.obj"), Error);
  EXPECT_THROW((void)expand_glob(folder / "**/*.obj"), Error);
  fs::permissions(folder / "closed", fs::perms::owner_all);
}

TEST(Manifest, ErrorsNameTheLine) {
  const test::TempFolder folder;
  const auto message = [&](const std::string& text) {
    return error_of(folder.write("m.jsonl", text), folder / "o");
  };
  const std::string good = "{\"mesh\": \"a.obj\"}\n";
  EXPECT_NE(message(good + "{\"mesh\": ").find("m.jsonl: line 2: "), std::string::npos);
  EXPECT_NE(message(good + "[1]").find("line 2"), std::string::npos);
  EXPECT_NE(message(good + "{\"out\": \"x\"}").find("\"mesh\" is missing"), std::string::npos);
  EXPECT_NE(message("{\"mesh\": \"a.obj\", \"mesage\": \"x\"}").find("unknown key \"mesage\""),
            std::string::npos);
  EXPECT_NE(message("{\"mesh\": 5}").find("line 1"), std::string::npos);
  EXPECT_NE(message("{\"mesh\": \"*.obj\"}").find("matches no file"), std::string::npos);
  EXPECT_NE(message("{\"mesh\": \"a.obj\", \"message_hex\": \"xyz\"}").find("line 1"),
            std::string::npos);
  EXPECT_NE(message("{\"triglyph\": 2}").find("line 1"), std::string::npos);
  EXPECT_NE(message(good + "{\"triglyph\": 1}").find("line 2"), std::string::npos);
  EXPECT_NE(error_of(folder.write("m.jsonl", good)).find("no --out"), std::string::npos);
  EXPECT_NE(error_of(folder / "absent.jsonl").find("cannot be read"), std::string::npos);
}

// Every value is checked when its line is read, whatever it is for.
TEST(Manifest, RefusesValuesThatCannotBe) {
  const test::TempFolder folder;
  const auto message = [&](const std::string& keys) {
    return error_of(folder.write("m.jsonl", "\n{\"mesh\": \"a.obj\", " + keys + "}"), folder / "o");
  };
  const auto refuses = [&](const std::string& keys, const std::string& reason) {
    const std::string text = message(keys);
    EXPECT_NE(text.find("m.jsonl: line 2: "), std::string::npos) << keys << ": " << text;
    EXPECT_NE(text.find(reason), std::string::npos) << keys << ": " << text;
  };
  EXPECT_EQ(message("\"max_move\": 5"), "");
  refuses("\"max_move\": 500", "\"max_move\"");
  refuses("\"max_move\": -1", "\"max_move\"");
  refuses("\"max_move\": \"5\"", "\"max_move\"");
  refuses("\"redundancy\": -1", "\"redundancy\"");
  refuses("\"redundancy\": 2.5", "\"redundancy\"");
  refuses("\"redundancy\": 18446744073709551615", "\"redundancy\"");
  refuses("\"redundancy\": null", "\"redundancy\"");
  refuses("\"redundancy\": 3, \"redundancy\": 4", "comes twice");
  refuses("\"layout\": \"best\"", "first-fit, min-degree");
  refuses("\"scheme\": \"xyz\"", "tsq, aie, iie");
  refuses("\"message\": \"a\", \"fill\": true", "exclude each other");
  refuses("\"message\": \"a\", \"message_hex\": \"00\"", "exclude each other");
  refuses("\"message\": \"\"", "1 to 256 bytes");
  refuses("\"radius_edges\": 4", "no option of scheme auto");
  refuses("\"scheme\": \"iie\", \"step\": 0.5", "\"step\"");
  refuses("\"subscript_bits\": 2", "subscript bits");
  refuses("\"detail\": 1", "\"detail\" must be true or false");
  EXPECT_EQ(message("\"message\": \"a\", \"fill\": false"), "");
}

TEST(Manifest, RefusesDeepNestingWithoutFollowingIt) {
  const test::TempFolder folder;
  const std::string deep(1000000, '[');
  const std::string text = error_of(folder.write("m.jsonl", "{\"mesh\": " + deep), folder / "o");
  EXPECT_NE(text.find("line 1: nested"), std::string::npos) << text.substr(0, 200);
}

TEST(CheckPlan, RefusesOutputsThatWouldDestroyAnything) {
  const test::TempFolder folder;
  folder.write("a.obj", "");
  folder.write("b.obj", "");
  fs::create_symlink(folder / "b.obj", folder / "link.obj");
  fs::create_directory_symlink(folder.path(), folder / "same");
  const auto plan = [&](const std::string& text) -> std::string {
    try {
      ManifestReader reader(folder.write("m.jsonl", text), {{"message", std::string("any")}},
                            folder / "o");
      check_plan(reader);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(plan("{\"mesh\": \"a.obj\"}\n{\"mesh\": \"b.obj\"}"), "");
  EXPECT_NE(plan("{\"mesh\": \"a.obj\", \"out\": \"a.obj\"}"), "");
  EXPECT_NE(plan("{\"mesh\": \"a.obj\", \"out\": \"./same/x/../b.obj\"}\n{\"mesh\": \"b.obj\"}"),
            "");
  EXPECT_NE(plan("{\"mesh\": \"a.obj\", \"out\": \"same/a.obj\"}"), "");
  EXPECT_NE(plan("{\"mesh\": \"a.obj\", \"out\": \"b.obj\"}\n{\"mesh\": \"link.obj\"}"), "");
  EXPECT_NE(plan("{\"mesh\": \"a.obj\", \"out\": \"c.obj\"}\n"
                 "{\"mesh\": \"b.obj\", \"out\": \"same/c.obj\"}"),
            "");
}

TEST(MeshList, PutsFilesIntoOneFolder) {
  MeshList list({{"x/a.obj", "x"}, {"b.stl", ""}}, {{"message", std::string("any")}}, "out");
  const auto jobs = jobs_of(list);
  ASSERT_EQ(jobs.size(), 2U);
  EXPECT_EQ(jobs[0].out, "out/a.obj");
  EXPECT_EQ(jobs[1].out, "out/b.stl");
}

}  // namespace
}  // namespace triglyph
