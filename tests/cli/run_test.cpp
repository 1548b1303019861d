// Runs over collections as a user starts them: nothing lost, nothing twice, no silent surprise.
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/cli/cli_fixture.h"

namespace triglyph {
namespace {

namespace fs = std::filesystem;

using RunResult = test::CliResult;

class CliRun : public test::CliTest {
 protected:
  void make_samples(std::size_t count, std::size_t triangles = 2500) const {
    for (std::size_t i = 0; i < count; ++i) {
      make_sample("in/" + std::to_string(i) + ".obj", triangles, i);
    }
  }

  [[nodiscard]] std::vector<nlohmann::json> lines(const std::string& text) const {
    std::vector<nlohmann::json> all;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) all.push_back(nlohmann::json::parse(line));
    return all;
  }
};

TEST_F(CliRun, SameCommandAgainDoesOnlyWhatIsMissing) {
  make_samples(4);
  const std::string command = "mark in --out out --message m --json --records r.jsonl";
  const RunResult first = run(command);
  ASSERT_EQ(first.code, 0) << first.err;
  EXPECT_TRUE(fs::exists(folder_ / "out.ledger"));  // beside the folder that is handed out
  fs::remove(folder_ / "out/2.obj");
  const auto time = fs::last_write_time(folder_ / "out/1.obj");
  const RunResult plan = run("mark in --out out --message m --dry-run");
  EXPECT_NE(plan.out.find("mark in/2.obj -> out/2.obj (the output is gone"), std::string::npos)
      << plan.out;
  EXPECT_NE(plan.out.find("keep in/1.obj -> out/1.obj"), std::string::npos) << plan.out;
  EXPECT_FALSE(fs::exists(folder_ / "out/2.obj"));
  const RunResult second = run(command);
  EXPECT_EQ(second.code, 0) << second.err;
  EXPECT_NE(second.err.find("4 meshes: 4 marked (3 as an earlier run left them)"),
            std::string::npos)
      << second.err;
  EXPECT_EQ(fs::last_write_time(folder_ / "out/1.obj"), time);
  auto before = lines(first.out);
  auto after = lines(second.out);
  const auto recorded = lines(test::read_all(folder_ / "r.jsonl"));
  ASSERT_EQ(after.size(), 4U);
  ASSERT_EQ(recorded.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(recorded[i], after[i]);
    before[i].erase("run");
    after[i].erase("run");
    EXPECT_EQ(before[i], after[i]);
  }
  EXPECT_EQ(lines(run("ledger marks out.ledger").out).size(), 4U);
  EXPECT_EQ(lines(run("ledger export out.ledger").out).size(), 4U);
  const auto runs = lines(run("ledger runs out.ledger").out);
  ASSERT_EQ(runs.size(), 2U);
  EXPECT_EQ(runs[1]["outcome"], "done");
}

// What an older build recorded is as good as what it did itself.
TEST_F(CliRun, ImportedRecordsNeedNotBeDoneAgain) {
  make_samples(2);
  ASSERT_EQ(run("mark in --out out --message m --records r.jsonl").code, 0);
  fs::remove(folder_ / "out.ledger");
  EXPECT_EQ(run("ledger import out.ledger r.jsonl").out, "2 records imported\n");
  const RunResult again = run("mark in --out out --message m");
  EXPECT_NE(again.err.find("(2 as an earlier run left them)"), std::string::npos) << again.err;
  EXPECT_EQ(run("ledger import out.ledger").code, 2);
  EXPECT_EQ(run("ledger marks r.jsonl").code, 2);
}

TEST_F(CliRun, AMeshThatCrashesOrHangsCostsOneRecord) {
  make_samples(8);
  for (const char* threads : {"1", "2"}) {
    const std::string out = std::string("out") + threads;
    const std::string command = "mark in --out " + out + " --message m --timeout 20 --threads " +
                                threads + " --records " + out + ".jsonl";
    const RunResult crashed = run(command, "TRIGLYPH_FAULT='crash 3.obj'");
    EXPECT_EQ(crashed.code, 3);
    const auto records = lines(test::read_all(folder_ / (out + ".jsonl")));
    ASSERT_EQ(records.size(), 8U) << crashed.err;
    for (std::size_t i = 0; i < 8; ++i) {
      EXPECT_EQ(records[i]["status"], i == 3 ? "crashed" : "marked");
      EXPECT_EQ(records[i]["run"]["place"], i);
      EXPECT_EQ(fs::exists(folder_ / out / (std::to_string(i) + ".obj")), i != 3);
    }
    // it is not tried again, until it is asked for
    const RunResult again = run(command);
    EXPECT_EQ(again.code, 3);
    EXPECT_NE(again.err.find("1 crashed (8 as an earlier run left them)"), std::string::npos)
        << again.err;
    EXPECT_EQ(run(command + " --force").code, 0);
  }
  const RunResult slow = run("mark in --out slow --message m --timeout 0.5 --json --threads 1",
                             "TRIGLYPH_FAULT='hang 3.obj'");
  EXPECT_EQ(slow.code, 3);
  EXPECT_EQ(lines(slow.out)[3]["status"], "too slow");
  EXPECT_EQ(lines(slow.out).size(), 8U);
}

TEST_F(CliRun, ReadersSurviveACrashToo) {
  make_samples(5);
  ASSERT_EQ(run("mark in --out out --message m --records r.jsonl").code, 0);
  const std::string fault = "TRIGLYPH_FAULT='crash 2.obj'";
  const RunResult extracted = run("extract out --json", fault);
  EXPECT_EQ(extracted.code, 3);
  const auto readings = lines(extracted.out);
  ASSERT_EQ(readings.size(), 5U) << extracted.out;
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(readings[i]["status"], i == 2 ? "crashed" : "marked");
  }
  const RunResult verified = run("verify r.jsonl --json", fault);
  EXPECT_EQ(verified.code, 3);
  EXPECT_EQ(lines(verified.out).size(), 5U);
  const RunResult measured = run("measure in out --json", fault);
  EXPECT_EQ(measured.code, 3);
  ASSERT_EQ(lines(measured.out).size(), 5U);
  EXPECT_EQ(lines(measured.out)[2]["status"], "crashed");
}

TEST_F(CliRun, ALedgerKeepsWhatReadersFound) {
  make_samples(3);
  ASSERT_EQ(run("mark in --out out --message m").code, 0);
  folder_.write("out/1.obj", "v x\n");
  const std::string log = " --ledger out.ledger";
  EXPECT_EQ(run("extract out" + log).code, 3);
  EXPECT_EQ(run("verify" + log, "TRIGLYPH_FAULT='crash 2.obj'").code, 3);
  const RunResult measured = run("measure in out --json" + log);
  EXPECT_EQ(measured.code, 3);
  const auto results = lines(run("ledger results out.ledger").out);
  ASSERT_EQ(results.size(), 9U);
  const std::vector<std::string> statuses = {"marked",   "malformed", "marked",
                                             "intact",   "damaged",   "damaged",
                                             "measured", "malformed", "measured"};
  for (std::size_t i = 0; i < 9; ++i) {
    EXPECT_EQ(results[i]["run"], 2 + i / 3);
    EXPECT_EQ(results[i]["place"], i % 3);
    EXPECT_EQ(results[i]["status"], statuses[i]) << i;
    const std::string folder = i < 6 ? "/out/" : "/in/";
    EXPECT_NE(results[i]["file"].get<std::string>().find(folder + std::to_string(i % 3) + ".obj"),
              std::string::npos);
  }
  EXPECT_EQ(results[0]["result"]["message_hex"], "6d");
  EXPECT_NE(results[1]["result"]["error"].get<std::string>().find("line 1"), std::string::npos);
  EXPECT_EQ(results[6]["result"], lines(measured.out)[0]);
  EXPECT_EQ(lines(run("ledger export out.ledger").out).size(), 3U);  // outputs alone
}

TEST_F(CliRun, MeasureComparesFoldersAndRecords) {
  make_samples(3);
  ASSERT_EQ(run("mark in --out out --message m --records r.jsonl").code, 0);
  const auto folders = lines(run("measure in out --json").out);
  const auto records = lines(run("measure r.jsonl --json").out);
  const auto ledger = lines(run("measure out.ledger --json").out);
  ASSERT_EQ(folders.size(), 3U);
  ASSERT_EQ(records.size(), 3U);
  ASSERT_EQ(ledger.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_GT(folders[i]["hausdorff"], 0);
    EXPECT_EQ(folders[i]["hausdorff"], records[i]["hausdorff"]);
    EXPECT_EQ(folders[i]["hausdorff"], ledger[i]["hausdorff"]);
  }
  fs::remove(folder_ / "out/1.obj");
  const RunResult missing = run("measure in out --json");
  EXPECT_EQ(missing.code, 3);
  EXPECT_EQ(lines(missing.out)[1]["status"], "unreadable");
  EXPECT_EQ(run("measure in out/0.obj").code, 2);
}

TEST_F(CliRun, VerifyFindsFilesFromWhereTheRunStoodOrBelowARoot) {
  make_samples(2);
  ASSERT_EQ(run("mark in --out out --message m --records r.jsonl").code, 0);
  const std::string here = folder_.path().string();
  fs::create_directory(folder_ / "elsewhere");
  EXPECT_EQ(run("verify r.jsonl; cd elsewhere; '" TRIGLYPH_EXECUTABLE "' verify ../r.jsonl").code,
            0);
  fs::create_directory(folder_ / "moved");
  fs::rename(folder_ / "out", folder_ / "moved/out");
  EXPECT_EQ(run("verify r.jsonl").code, 3);
  EXPECT_EQ(run("verify r.jsonl --root moved").code, 0);
  fs::rename(folder_ / "moved/out", folder_ / "out");
  EXPECT_EQ(run("verify --ledger out.ledger").code, 0);
  EXPECT_EQ(run("verify out/1.obj --ledger out.ledger").code, 0);
  EXPECT_EQ(run("verify in/1.obj --ledger out.ledger").code, 3);  // not an output
  EXPECT_EQ(run("verify").code, 2);
  folder_.write("empty.jsonl", "");
  EXPECT_EQ(run("verify empty.jsonl").code, 2);  // no records is not "all is well"
}

// The cut of a quad that is nearly square and flat turns over once its corners move. What the
// reason names helps.
TEST_F(CliRun, QuadsWhoseCutTurnsOverAreNotVerifiedAndTrianglesAre) {
  constexpr int kSide = 20;
  std::string points;
  std::string quads;
  std::string triangles;
  for (int i = 0; i <= kSide; ++i) {
    for (int j = 0; j <= kSide; ++j) {
      const auto shaken = [&](int seed) { return (i * 37 + j * 101 + seed * i * j) % 13 * 1e-4; };
      points += "v " + std::to_string(i + shaken(7)) + " " + std::to_string(j + shaken(11)) + " " +
                std::to_string(shaken(17)) + "\n";
      if (i == kSide || j == kSide) continue;
      const int at = i * (kSide + 1) + j + 1;
      const std::string a = std::to_string(at) + " ";
      const std::string b = std::to_string(at + kSide + 1) + " ";
      const std::string c = std::to_string(at + kSide + 2) + " ";
      const std::string d = std::to_string(at + 1) + " ";
      quads.append("f ").append(a).append(b).append(c).append(d).append("\n");
      triangles.append("f ").append(a).append(b).append(c).append("\n");
      triangles.append("f ").append(a).append(c).append(d).append("\n");
    }
  }
  folder_.write("quads.obj", points + quads);
  folder_.write("triangles.obj", points + triangles);
  const RunResult refused = run("mark quads.obj --fill --out o --json");
  EXPECT_EQ(refused.code, 3);
  EXPECT_EQ(lines(refused.out)[0]["status"], "not verified");
  EXPECT_NE(refused.err.find("export the mesh as triangles"), std::string::npos) << refused.err;
  EXPECT_EQ(run("mark triangles.obj --fill --out o").code, 0);
}

TEST_F(CliRun, AMeshWithoutTheMemoryItTakesSaysSo) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "the sanitizers' own memory has no limit";
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
  GTEST_SKIP() << "the sanitizers' own memory has no limit";
#endif
#endif
  make_samples(1, 300000);
  const RunResult result =
      run("mark in --message m --out out --threads 1 --json", "ulimit -v 160000;");
  EXPECT_EQ(result.code, 3) << result.err;
  const auto records = lines(result.out);
  ASSERT_EQ(records.size(), 1U) << result.err;
  EXPECT_EQ(records[0]["status"], "failed");
  EXPECT_NE(result.err.find("not enough memory: this mesh takes about "), std::string::npos)
      << result.err;
}

TEST_F(CliRun, GivesUpAfterTooManyFailures) {
  make_samples(2);
  for (int i = 0; i < 6; ++i) folder_.write("in/a" + std::to_string(i) + ".obj", "v x\n");
  const auto failures = [&](const std::string& limit) {
    const RunResult result =
        run("mark in --out out --message m --json --force --threads 1 " + limit);
    EXPECT_EQ(result.code, 3) << limit;
    EXPECT_EQ(result.err.find("given up") == std::string::npos, limit.empty()) << limit;
    std::size_t count = 0;
    for (const auto& record : lines(result.out)) count += record["status"] == "malformed" ? 1 : 0;
    return count;
  };
  EXPECT_EQ(failures(""), 6U);
  EXPECT_GE(failures("--max-failures 3"), 4U);
  EXPECT_GE(failures("--max-failures 25%"), 3U);
  EXPECT_GE(failures("--fail-fast"), 1U);
  for (const char* wrong : {"-1", "x", "2.5", "101%", "%", "5%%", "nan"}) {
    EXPECT_EQ(run("mark in --out o --message m --max-failures " + std::string(wrong)).code, 2)
        << wrong;
  }
}

TEST_F(CliRun, QuietPrintsErrorsAlone) {
  make_samples(1);
  const RunResult result = run("mark in --out out --message m --quiet --key-file k", "");
  EXPECT_EQ(result.code, 2);  // no such key
  ASSERT_EQ(run("keygen --out k").code, 0);
  const RunResult quiet = run("mark in --out out --message m --quiet --key-file k");
  EXPECT_EQ(quiet.code, 0);
  EXPECT_EQ(quiet.out, "");
  EXPECT_EQ(quiet.err, "");
}

// Whatever the number of threads, a record follows its file within a second. The run hangs in the
// smallest mesh, which it starts last.
TEST_F(CliRun, RecordsAreThereAsSoonAsTheirFiles) {
  make_samples(40, 600);
  folder_.write("in/last.obj", "v");
  for (const char* threads : {"1", "2"}) {
    const std::string out = std::string("out") + threads;
    const std::string records = out + ".jsonl";
    const std::string script = "cd '" + folder_.path().string() +
                               "'\nTRIGLYPH_FAULT='hang last.obj' '" TRIGLYPH_EXECUTABLE
                               "' mark in --message m --out " +
                               out + " --threads " + threads + " --records " + records +
                               " >/dev/null 2>&1 &\n"
                               "for i in $(seq 600); do\n"
                               "  [ \"$(ls " +
                               out +
                               " 2>/dev/null | wc -l)\" -ge 40 ] && break\n"
                               "  sleep 0.1\ndone\nsleep 1\n"
                               "cp " +
                               records + " seen\nkill -KILL $!\n";
    folder_.write("script.sh", script);
    (void)std::system(("bash '" + (folder_ / "script.sh").string() + "'").c_str());
    EXPECT_EQ(lines(test::read_all(folder_ / "seen")).size(), 40U) << threads;
  }
}

TEST_F(CliRun, FilesOfTheRunNeverReplaceOneAnother) {
  make_samples(2);
  ASSERT_EQ(run("keygen --out k").code, 0);
  folder_.write("m.jsonl", "{\"mesh\": \"in/0.obj\", \"message\": \"m\"}\n");
  folder_.write("notes.txt", "to buy: milk\n");
  const auto content = [&] {
    std::string all;
    for (const char* name : {"k", "m.jsonl", "in/0.obj", "in/1.obj", "notes.txt"}) {
      all += test::read_all(folder_ / name);
    }
    return all;
  };
  const std::string before = content();
  fs::create_symlink("k", folder_ / "link");
  for (const char* wrong :
       {"mark in --message m --out o --key-file k --records k",
        "mark in --message m --out o --key-file k --records link",
        "mark in --message m --out o --key-file k --ledger k",
        "mark m.jsonl --out o --records in/0.obj", "mark m.jsonl --out o --records m.jsonl",
        "mark m.jsonl --out o --ledger in/0.obj", "mark m.jsonl --out o --records r --ledger r",
        "mark m.jsonl --out in/.. --records in/../in/0.obj", "mark m.jsonl --out .",
        "mark in --message m --out o --records o/0.obj", "mark m.jsonl --out o --records notes.txt",
        "mark in --message m --out o --ledger notes.txt"}) {
    const RunResult result = run(wrong);
    EXPECT_EQ(result.code, 2) << wrong << result.err;
    EXPECT_EQ(content(), before) << wrong;
  }
  EXPECT_FALSE(fs::exists(folder_ / "o/0.obj"));
}

TEST_F(CliRun, NamesThatMisleadAreRefusedOrShownPlainly) {
  make_samples(1);
  const std::string before = test::read_all(folder_ / "in/0.obj");
  for (const char* name : {"in/0.obj\\u0000x.obj", "a\\u001b[2Jb.obj", "a\\nb.obj", ""}) {
    folder_.write("m.jsonl", "{\"mesh\": \"in/0.obj\", \"message\": \"m\", \"out\": \"" +
                                 std::string(name) + "\"}\n");
    const RunResult result = run("mark m.jsonl");
    EXPECT_EQ(result.code, 2) << name;
    EXPECT_NE(result.err.find("m.jsonl: line 1: "), std::string::npos) << result.err;
  }
  EXPECT_EQ(test::read_all(folder_ / "in/0.obj"), before);
  // a file whose name is not UTF-8, and one that would clear the screen, found by a folder's name
  fs::rename(folder_ / "in/0.obj", folder_ / "in/\xff\x1b[2J.obj");
  const RunResult odd = run("mark in --message m --out out --records r.jsonl");
  EXPECT_EQ(odd.code, 0) << odd.err;
  EXPECT_EQ(odd.out.find('\x1b'), std::string::npos);
  EXPECT_NE(odd.out.find("in/\\xff\\x1b[2J.obj"), std::string::npos) << odd.out;
  EXPECT_TRUE(fs::exists(folder_ / "out/\xff\x1b[2J.obj"));
  EXPECT_EQ(run("verify r.jsonl").code, 0);  // the record names it exactly
  EXPECT_EQ(lines(test::read_all(folder_ / "r.jsonl"))[0]["out_bytes"],
            "6f75742fff1b5b324a2e6f626a");
}

TEST_F(CliRun, AFullStandardOutputIsAnError) {
  make_samples(1);
  for (const char* command : {"mark in --message m --out out", "extract in", "--help", "--version",
                              "measure in in", "mark in --message m --out p --json"}) {
    const RunResult result = run(std::string(command) + " >/dev/full");
    EXPECT_EQ(result.code, 1) << command;
    EXPECT_NE(result.err.find("standard output"), std::string::npos) << result.err;
  }
  EXPECT_TRUE(fs::exists(folder_ / "out/0.obj"));
}

TEST_F(CliRun, MistypedWordsGetASuggestion) {
  EXPECT_NE(run("mrak a.obj").err.find("did you mean mark?"), std::string::npos);
  EXPECT_NE(run("mark a.obj --mesage x").err.find("did you mean --message?"), std::string::npos);
  EXPECT_EQ(run("frobnicate").err.find("did you mean"), std::string::npos);
}

TEST_F(CliRun, MessagesInUtf8AreShownAsText) {
  make_samples(1, 6000);
  ASSERT_EQ(run("mark in --out out --message 'für Ada ✓'").code, 0);
  EXPECT_NE(run("extract out").out.find("\"für Ada ✓\""), std::string::npos);
  ASSERT_EQ(run("mark in --out o2 --message-hex 00ff1b").code, 0);
  EXPECT_NE(run("extract o2").out.find("0x00ff1b"), std::string::npos);
}

TEST_F(CliRun, ALineOverridesAGlobThatMatchesItsMesh) {
  make_samples(3);
  folder_.write("m.jsonl",
                "{\"mesh\": \"in/*.obj\", \"message\": \"all\"}\n"
                "{\"mesh\": \"in/1.obj\", \"message\": \"one\"}\n");
  const RunResult result = run("mark m.jsonl --out out --json");
  ASSERT_EQ(result.code, 0) << result.err;
  const auto records = lines(result.out);
  ASSERT_EQ(records.size(), 3U);
  EXPECT_EQ(records[0]["message_hex"], "616c6c");
  EXPECT_EQ(records[1]["message_hex"], "616c6c");
  EXPECT_EQ(records[2]["message_hex"], "6f6e65");
  EXPECT_NE(records[2]["mesh"].get<std::string>().find("in/1.obj"), std::string::npos);
}

TEST_F(CliRun, DeepOrEndlessLinesOfAManifestAreErrors) {
  folder_.write("deep.jsonl", "{}\n{\"mesh\": " + std::string(1000000, '[') + "\n");
  const RunResult deep = run("mark deep.jsonl --out o");
  EXPECT_EQ(deep.code, 2);
  EXPECT_NE(deep.err.find("deep.jsonl: line "), std::string::npos) << deep.err;
  folder_.write("long.jsonl", "{\"mesh\": \"" + std::string(std::size_t{65} << 20, 'a'));
  const RunResult endless = run("mark long.jsonl --out o");
  EXPECT_EQ(endless.code, 2);
  EXPECT_NE(endless.err.find("long.jsonl: line 1: longer than 64 MiB"), std::string::npos);
}

TEST_F(CliRun, WhatWasNotMarkedHasNoDistance) {
  folder_.write("in/bad.obj", "v 1 2\n");
  const auto record = lines(run("mark in --out out --message m --json").out)[0];
  EXPECT_FALSE(record.contains("hausdorff"));
  EXPECT_FALSE(record.contains("displacement_max"));
}

TEST_F(CliRun, ModesComeAlongAndOnRequestTimesAndCompanions) {
  make_samples(1);
  folder_.write("in/a.mtl", "newmtl a\n");
  const std::string mesh = test::read_all(folder_ / "in/0.obj");
  folder_.write("in/0.obj", "mtllib a.mtl\n" + mesh);
  fs::permissions(folder_ / "in/0.obj", fs::perms(0640));
  const auto old = fs::file_time_type::clock::now() - std::chrono::hours(1000);
  fs::last_write_time(folder_ / "in/0.obj", old);
  ASSERT_EQ(run("mark in --message m --out o").code, 0);
  EXPECT_EQ(fs::status(folder_ / "o/0.obj").permissions(), fs::perms(0640));
  EXPECT_NE(fs::last_write_time(folder_ / "o/0.obj"), fs::last_write_time(folder_ / "in/0.obj"));
  EXPECT_FALSE(fs::exists(folder_ / "o/a.mtl"));
  ASSERT_EQ(run("mark in --message m --out p --keep-times --companions").code, 0);
  EXPECT_EQ(fs::last_write_time(folder_ / "p/0.obj"), fs::last_write_time(folder_ / "in/0.obj"));
  EXPECT_EQ(test::read_all(folder_ / "p/a.mtl"), "newmtl a\n");
  folder_.write("q/a.mtl", "somebody's");
  const RunResult refused = run("mark in --message m --out q --companions --json");
  EXPECT_EQ(refused.code, 3);
  EXPECT_EQ(lines(refused.out)[0]["status"], "usage");
  EXPECT_FALSE(fs::exists(folder_ / "q/0.obj"));
}

// What was issued is known by its content, in whatever scheme it was marked.
TEST_F(CliRun, AnOutputIsNotMarkedAgainInAnotherScheme) {
  make_samples(1);
  ASSERT_EQ(run("mark in --message m --out o").code, 0);
  const std::string again = "mark o --scheme aie --message n --out p --ledger o.ledger --json";
  const RunResult refused = run(again);
  EXPECT_EQ(refused.code, 3);
  EXPECT_EQ(lines(refused.out)[0]["status"], "already marked");
  EXPECT_NE(refused.err.find("\"m\" in scheme auto; --remark"), std::string::npos) << refused.err;
  ASSERT_EQ(run("keygen --out k").code, 0);
  EXPECT_EQ(run(again + " --key-file k").code, 0);  // another owner knows nothing of it
  EXPECT_EQ(run(again + " --remark --force").code, 0);
}

// A folder of outputs below the folder that is marked holds what the run before wrote.
TEST_F(CliRun, OutputsBelowTheInputsAreNoInputs) {
  make_samples(2);
  folder_.write("m.jsonl", "{\"mesh\": \"in/**/*.obj\", \"message\": \"m\"}\n");
  for (const char* command :
       {"mark in --message m --out in/marked", "mark 'in/**/*.obj' --message m --out ./in/marked",
        "mark m.jsonl --out in/marked"}) {
    for (int i = 0; i < 2; ++i) {
      const RunResult result = run(command);
      EXPECT_EQ(result.code, 0) << command << result.err;
      EXPECT_NE(result.err.find("2 meshes: 2 marked"), std::string::npos) << result.err;
    }
    fs::remove_all(folder_ / "in/marked");
    fs::remove(folder_ / "in/marked.ledger");
  }
  EXPECT_EQ(run("mark in --message m --out in").code, 2);
  EXPECT_EQ(run("mark in/0.obj --message m --out in").code, 2);
}

}  // namespace
}  // namespace triglyph
