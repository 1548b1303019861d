// The verb sweep.
#include <algorithm>
#include <fstream>
#include <map>
#include <sstream>

#include <pugixml.hpp>

#include "cli/junit_report.h"
#include "manifests/json_line.h"
#include "manifests/ledger.h"
#include "tests/cli/cli_fixture.h"

namespace triglyph {
namespace {

namespace fs = std::filesystem;

class SweepCli : public test::CliTest {
 protected:
  static constexpr int kFiles = 6;

  void SetUp() override {
    for (int i = 0; i < kFiles; ++i) {
      make_sample("in/" + std::to_string(i) + ".obj", 600, static_cast<std::uint64_t>(i));
    }
    ASSERT_EQ(run("mark in --out lib --scheme tsq --message hi --quiet").code, 0);
  }

  // Leaves one file missing, one altered and one moved.
  void touch_three() const {
    fs::remove(folder_ / "lib/1.obj");
    std::ofstream(folder_ / "lib/3.obj", std::ios::app) << "# a word\n";
    fs::rename(folder_ / "lib/5.obj", folder_ / "lib/six.obj");
  }

  [[nodiscard]] static std::size_t count_lines(const std::string& text) {
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
  }
};

TEST_F(SweepCli, IsSilentWithExitCode0WhenNothingChanged) {
  const test::CliResult clean = run("sweep --ledger lib.ledger");
  EXPECT_EQ(clean.code, 0) << clean.err;
  EXPECT_EQ(clean.out, "");
  EXPECT_NE(clean.err.find("6 files: 6 intact"), std::string::npos) << clean.err;
  EXPECT_EQ(count_lines(run("sweep --ledger lib.ledger --all").out), 6U);
}

TEST_F(SweepCli, SaysWhatChangedAsTextJsonAndJunitWithExitCode4) {
  touch_three();
  const test::CliResult text = run("sweep --ledger lib.ledger --junit report.xml");
  EXPECT_EQ(text.code, 4) << text.err;
  EXPECT_EQ(count_lines(text.out), 3U) << text.out;
  EXPECT_NE(text.out.find("lib/1.obj: missing, was intact"), std::string::npos) << text.out;
  EXPECT_NE(text.out.find("lib/3.obj: altered, was intact"), std::string::npos) << text.out;
  EXPECT_NE(text.out.find("lib/5.obj: moved, was intact (is now "), std::string::npos) << text.out;

  pugi::xml_document report;
  ASSERT_TRUE(report.load_file((folder_ / "report.xml").c_str()));
  const pugi::xml_node suite = report.child("testsuites").child("testsuite");
  EXPECT_EQ(suite.attribute("tests").as_int(), kFiles);
  EXPECT_EQ(suite.attribute("failures").as_int(), 3);
  EXPECT_EQ(suite.attribute("errors").as_int(), 0);
  std::map<std::string, std::string> failures;
  int tests = 0;
  for (const pugi::xml_node test : suite.children("testcase")) {
    ++tests;
    if (const auto failure = test.child("failure")) {
      failures[test.attribute("name").value()] = failure.attribute("type").value();
    }
  }
  EXPECT_EQ(tests, kFiles);
  EXPECT_EQ(failures, (std::map<std::string, std::string>{
                          {"1.obj", "missing"}, {"3.obj", "altered"}, {"5.obj", "moved"}}));

  const test::CliResult json = run("sweep --ledger lib.ledger --json");
  EXPECT_EQ(json.code, 4);  // what is wrong stays wrong until somebody accepts it
  std::istringstream lines(json.out);
  std::map<std::string, std::string> states;
  for (std::string line; std::getline(lines, line);) {
    const nlohmann::ordered_json one = parse_json_line(line);
    EXPECT_EQ(one["change"], "unchanged");
    states[fs::path(std::string(one["out"])).filename()] = one["state"];
  }
  EXPECT_EQ(states, failures);
}

TEST_F(SweepCli, EntersNewsIntoTheLedgerAndNothingElse) {
  ASSERT_EQ(run("sweep --ledger lib.ledger").code, 0);
  touch_three();
  ASSERT_EQ(run("sweep --ledger lib.ledger").code, 4);
  const Ledger ledger(folder_ / "lib.ledger");
  std::map<std::string, std::string> results;
  ledger.for_each_result([&](const LedgerResult& result) {
    results[fs::path(result.file).filename()] = result.status;
  });
  EXPECT_EQ(results, (std::map<std::string, std::string>{
                         {"1.obj", "missing"}, {"3.obj", "altered"}, {"5.obj", "moved"}}));
  std::string outcomes;
  ledger.for_each_run([&](const LedgerRun& one) { outcomes += one.outcome + ";"; });
  EXPECT_EQ(outcomes, "done;done;changed;");
}

TEST_F(SweepCli, AcceptsWhatTheOwnerDid) {
  touch_three();
  EXPECT_EQ(run("sweep --ledger lib.ledger --accept lib/1.obj lib/5.obj").code, 0);
  const test::CliResult rest = run("sweep --ledger lib.ledger");
  EXPECT_EQ(rest.code, 4);
  EXPECT_EQ(count_lines(rest.out), 1U) << rest.out;
  EXPECT_NE(rest.err.find("2 accepted"), std::string::npos) << rest.err;
}

TEST_F(SweepCli, AFileThatCannotBeLookedAtIsAnErrorAndExitCode3) {
  const test::CliResult crashed =
      run("sweep --ledger lib.ledger --junit report.xml", "TRIGLYPH_FAULT='crash 2.obj'");
  EXPECT_EQ(crashed.code, 3) << crashed.err;
  EXPECT_NE(crashed.out.find("lib/2.obj: unreadable, was intact"), std::string::npos)
      << crashed.out;
  pugi::xml_document report;
  ASSERT_TRUE(report.load_file((folder_ / "report.xml").c_str()));
  EXPECT_EQ(report.child("testsuites").attribute("errors").as_int(), 1);
  EXPECT_EQ(report.child("testsuites").attribute("tests").as_int(), kFiles);
  const test::CliResult after = run("sweep --ledger lib.ledger");
  EXPECT_EQ(after.code, 4);
  EXPECT_NE(after.out.find("lib/2.obj: intact again, was unreadable"), std::string::npos)
      << after.out;
}

TEST_F(SweepCli, GoesOnAfterItsTime) {
  const test::CliResult first = run("sweep --ledger lib.ledger --max-duration 0.000001s");
  EXPECT_EQ(first.code, 0);
  EXPECT_NE(first.err.find("the same command goes on"), std::string::npos) << first.err;
  std::string outcome;
  Ledger(folder_ / "lib.ledger").for_each_run([&](const LedgerRun& one) { outcome = one.outcome; });
  EXPECT_EQ(outcome, "out of time");
}

TEST_F(SweepCli, WrongArgumentsEndInOneLine) {
  for (const char* arguments :
       {"", "--ledger in/0.obj", "--ledger lib.ledger --subset 0/7",
        "--ledger lib.ledger --subset 8/7", "--ledger lib.ledger --subset 1/7x",
        "--ledger lib.ledger --sample 5", "--ledger lib.ledger --sample 0%",
        "--ledger lib.ledger --sample nan%", "--ledger lib.ledger elsewhere",
        "--ledger lib.ledger --search nowhere", "--ledger lib.ledger --max-duration 3parsecs"}) {
    const test::CliResult result = run(std::string("sweep ") + arguments + " --key-file k");
    EXPECT_EQ(result.code, 2) << arguments;
  }
  ASSERT_EQ(run("keygen --out k").code, 0);
  for (const char* arguments : {"", "--ledger in/0.obj", "--ledger lib.ledger --subset 8/7",
                                "--ledger lib.ledger --sample 5", "--ledger lib.ledger elsewhere",
                                "--ledger lib.ledger --search nowhere"}) {
    const test::CliResult result = run(std::string("sweep ") + arguments + " --key-file k");
    EXPECT_EQ(result.code, 2) << arguments;
    EXPECT_EQ(count_lines(result.err), 1U) << result.err;
  }
}

TEST(JunitReport, HoldsAnyName) {
  const test::TempFolder folder;
  Ledger ledger(folder / "l.ledger");
  const std::int64_t run = ledger.begin_run({.verb = "sweep"});
  const std::string name = "/a/<&\"'>]]>\xff\x01.obj";
  ledger.put_state({.target = name,
                    .state = "missing",
                    .change = "missing",
                    .expected = "",
                    .hash = "",
                    .line = R"({"before":"intact","detail":"a < b & \"c\"\u0001"})",
                    .run = run});
  write_junit_report(ledger, run, folder / "r.xml");
  pugi::xml_document report;
  ASSERT_TRUE(report.load_file((folder / "r.xml").c_str()));
  const pugi::xml_node test = report.child("testsuites").child("testsuite").child("testcase");
  EXPECT_STREQ(test.attribute("name").value(), "<&\"'>]]>\\xff\\x01.obj");
  EXPECT_STREQ(test.child("failure").text().get(), "a < b & \"c\"\\x01");
}

}  // namespace
}  // namespace triglyph
