// The real executable, as a user runs it: exit codes, stdout as data, stderr as messages, files.
#include <chrono>
#include <cmath>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/cli/cli_fixture.h"
#include "tests/flux/flux_shapes.h"

namespace triglyph {
namespace {

namespace fs = std::filesystem;

using Result = test::CliResult;

class Cli : public test::CliTest {};

TEST_F(Cli, VersionAndHelpSucceedAndUsageErrorsAreTwo) {
  EXPECT_EQ(run("--version").code, 0);
  EXPECT_NE(run("--version").out.find("triglyph 0."), std::string::npos);
  EXPECT_EQ(run("--help").code, 0);
  EXPECT_EQ(run("mark --message x --help").code, 0);
  for (const char* wrong :
       {"", "frobnicate", "mark", "mark --message x a.obj --layout best --out o",
        "mark --message x a.obj", "mark a.obj --out o --message a --fill",
        "mark a.obj --out o --message-hex xy", "mark a.obj --out o --message ''", "extract",
        "mark --message x a.obj --out o --subscript-bits 2",
        "mark --message x a.obj --out o --threads 0", "extract a.obj --key-file absent.key",
        "mark --message x absent.jsonl --out o", "verify absent.jsonl"}) {
    const Result result = run(wrong);
    EXPECT_EQ(result.code, 2) << wrong;
    EXPECT_EQ(result.out, "") << wrong;
    EXPECT_NE(result.err, "") << wrong;
  }
}

TEST_F(Cli, MarksExtractsAndVerifies) {
  make_sample("a.obj", 4000);
  EXPECT_EQ(run("keygen --out k.key").code, 0);
  EXPECT_EQ(run("keygen --out k.key").code, 1);  // never overwritten
  const Result marked =
      run("mark a.obj --out o --message 'for Ada' --key-file k.key --records r.jsonl --json");
  EXPECT_EQ(marked.code, 0) << marked.err;
  EXPECT_EQ(marked.err.rfind("triglyph: 1 mesh: 1 marked; ", 0), 0U) << marked.err;
  EXPECT_EQ(marked.out, test::read_all(folder_ / "r.jsonl"));
  const auto record = nlohmann::json::parse(marked.out);
  EXPECT_EQ(record["status"], "marked");
  EXPECT_EQ(record["message_hex"], "666f7220416461");

  const Result extracted = run("extract o/a.obj --key-file k.key");
  EXPECT_EQ(extracted.code, 0);
  EXPECT_NE(extracted.out.find("\"for Ada\""), std::string::npos);
  const Result as_json = run("extract o/a.obj --key-file k.key --json");
  EXPECT_EQ(nlohmann::json::parse(as_json.out)["message_hex"], "666f7220416461");

  const Result trial = run("extract o/a.obj");
  EXPECT_EQ(trial.code, 4);  // read, but without a mark
  EXPECT_NE(trial.out.find("no mark"), std::string::npos);
  EXPECT_NE(trial.err.find("trial key"), std::string::npos);
  EXPECT_EQ(run("extract a.obj --key-file k.key").code, 4);

  EXPECT_EQ(run("verify r.jsonl --key-file k.key").code, 0);
  const Result vague = run("verify r.jsonl --key-file k.key --detail");
  EXPECT_NE(vague.out.find("damage cannot be located"), std::string::npos);
  EXPECT_EQ(run("mark --message x a.obj --out o --key-file k.key --records d.jsonl --detail").code,
            0);
  const Result detail = run("verify d.jsonl --key-file k.key --detail");
  EXPECT_NE(detail.out.find("  0 of "), std::string::npos) << detail.out;
  fs::remove(folder_ / "o/a.obj");
  const Result missing = run("verify r.jsonl --key-file k.key --json");
  EXPECT_EQ(missing.code, 3);
  EXPECT_EQ(nlohmann::json::parse(missing.out)["verdict"], "missing");
}

// A reader asks for nothing that it can find out: scheme, key, and where the files are.
TEST_F(Cli, ExtractTriesEverySchemeAndKeyOverFoldersGlobsManifestsAndLists) {
  make_sample("in/a.obj", 4000);
  make_sample("in/b.obj", 4000);
  ASSERT_EQ(run("keygen --out k.key").code, 0);
  ASSERT_EQ(run("keygen --out l.key").code, 0);
  ASSERT_EQ(run("mark in/a.obj --out o --scheme tsq --message a --key-file k.key").code, 0);
  ASSERT_EQ(run("mark in/b.obj --out o --scheme aie --message b --key-file l.key").code, 0);
  folder_.write("m.jsonl", "{\"mesh\": \"o/*.obj\"}\n");
  folder_.write("o/note.txt", "not a mesh");
  const std::string keys = " --key-file k.key --key-file l.key --json";
  const Result named = run("extract o/a.obj o/b.obj" + keys);
  EXPECT_EQ(named.code, 0) << named.err;
  std::istringstream lines(named.out);
  std::string line;
  std::getline(lines, line);
  const auto first = nlohmann::json::parse(line);
  std::getline(lines, line);
  const auto second = nlohmann::json::parse(line);
  EXPECT_EQ(first["scheme"], "tsq");
  EXPECT_EQ(second["scheme"], "aie");
  EXPECT_EQ(second["message_hex"], "62");
  EXPECT_NE(first["key"], second["key"]);
  // the bound pays for every attempt: tsq and its strong marks with two keys as it is and turned
  // over, flux with two, then aie with the one key as it is and turned over and as it is with the
  // other
  EXPECT_EQ(first["false_alarm_bound"], std::ldexp(1.0, -32));
  EXPECT_EQ(second["false_alarm_bound"], std::ldexp(13.0, -32));
  for (const char* inputs : {"o", "'o/*.obj'", "m.jsonl", "o o/a.obj"}) {
    EXPECT_EQ(run("extract " + std::string(inputs) + keys).out, named.out) << inputs;
  }
  for (const char* list : {"o/a.obj\\no/b.obj\\n", "o/a.obj\\0o/b.obj\\0"}) {
    folder_.write("list.sh", "printf '" + std::string(list) +
                                 "' | '" TRIGLYPH_EXECUTABLE "' extract - " + keys);
    const std::string command = "cd '" + folder_.path().string() + "' && sh list.sh > .list";
    EXPECT_EQ(std::system(command.c_str()), 0);
    EXPECT_EQ(test::read_all(folder_ / ".list"), named.out) << list;
  }
  EXPECT_EQ(run("extract o --key-file k.key").code, 4);
  folder_.write("o/bad.obj", "v 1 2\nf 1 2 3\n");
  const Result bad = run("extract o" + keys);
  EXPECT_EQ(bad.code, 3);
  EXPECT_NE(bad.out.find("malformed"), std::string::npos);
  EXPECT_EQ(run("extract 'o/*.stl'" + keys).code, 2);
}

TEST_F(Cli, ExtractFindsMarksOfAnotherStepByTheRecordsThatNameIt) {
  make_sample("a.obj", 6000);
  const std::string made =
      "mark --message x a.obj --out o --step 0.03 --part-bits 12 --records r.jsonl";
  ASSERT_EQ(run(made).code, 0);
  EXPECT_EQ(run("extract o/a.obj").code, 4);
  EXPECT_EQ(run("extract o/a.obj --like r.jsonl").code, 0);
  EXPECT_EQ(run("extract o/a.obj --step 0.03 --part-bits 12").code, 0);
  folder_.write("bad.jsonl", "{\"schema\": 2}\n");
  const Result bad = run("extract o/a.obj --like bad.jsonl");
  EXPECT_EQ(bad.code, 2);
  EXPECT_NE(bad.err.find("bad.jsonl: line 1: "), std::string::npos) << bad.err;
}

// Percent is percent on the command line, in a config file, in a manifest and in a record.
TEST_F(Cli, AnOptionMeansTheSameEverywhere) {
  make_sample("a.obj", 3000);
  folder_.write("m.jsonl", "{\"mesh\": \"a.obj\", \"max_move\": 5}\n");
  folder_.write("c.toml", "[mark]\nmax-move = 5\n");
  folder_.write("d.toml", "[mark]\nmax_move = 5\n");
  for (const char* arguments : {"mark --message x a.obj --out o --max-move 5 --json",
                                "mark --message x m.jsonl --out o --json",
                                "--config c.toml mark --message x a.obj --out o --json",
                                "--config d.toml mark --message x a.obj --out o --json"}) {
    const Result result = run(arguments);
    ASSERT_EQ(result.code, 0) << arguments << result.err;
    EXPECT_EQ(nlohmann::json::parse(result.out)["options"]["max_move"], 5) << arguments;
  }
  for (const char* wrong : {"--max-move 500", "--max-move x", "--redundancy -1", "--redundancy 2.5",
                            "--radius-edges 4", "--detail=perhaps"}) {
    EXPECT_EQ(run("mark --message x a.obj --out o " + std::string(wrong)).code, 2) << wrong;
  }
}

TEST_F(Cli, MistakesInAConfigFileNameLineAndKey) {
  make_sample("a.obj", 3000);
  const auto refuses = [&](const std::string& text, const std::string& reason) {
    folder_.write("c.toml", text);
    const Result result = run("--config c.toml mark --message x a.obj --out o");
    EXPECT_EQ(result.code, 2) << text;
    EXPECT_NE(result.err.find("c.toml: line 2: "), std::string::npos) << result.err;
    EXPECT_NE(result.err.find(reason), std::string::npos) << result.err;
  };
  refuses("[mark]\nmax-moove = 5\n", "unknown key \"max-moove\"");
  refuses("[mark]\nmax-move = 500\n", "max_move");
  refuses("mark.step = 0.1\nmark.step = 0.2\n", "comes twice");
  refuses("[mark]\nredundancy = 2.5\n", "redundancy");
  EXPECT_FALSE(fs::exists(folder_ / "o"));
}

TEST_F(Cli, GoesOnAfterABadMeshAndSaysSo) {
  make_sample("good.obj", 3000);
  folder_.write("bad.obj", "v 1 2\nf 1 2 3\n");
  folder_.write("m.jsonl", "{\"mesh\": \"bad.obj\"}\n{\"mesh\": \"good.obj\"}\n");
  const Result result = run("mark --message x m.jsonl --out o --json");
  EXPECT_EQ(result.code, 3);
  std::istringstream lines(result.out);
  std::string line;
  std::getline(lines, line);
  const auto bad = nlohmann::json::parse(line);
  EXPECT_EQ(bad["status"], "malformed");
  EXPECT_NE(bad["error"].get<std::string>().find("bad.obj: line 1: "), std::string::npos);
  std::getline(lines, line);
  EXPECT_EQ(nlohmann::json::parse(line)["status"], "marked");
  EXPECT_TRUE(fs::exists(folder_ / "o/good.obj"));
  EXPECT_FALSE(fs::exists(folder_ / "o/bad.obj"));
}

TEST_F(Cli, TableIsOnStdoutAndNoProgressBarInAPipe) {
  make_sample("a.obj", 3000);
  const Result result = run("mark --message x a.obj --out o");
  EXPECT_EQ(result.code, 0);
  EXPECT_NE(result.out.find("verdict"), std::string::npos);
  EXPECT_NE(result.out.find("marked"), std::string::npos);
  EXPECT_EQ(result.err.find('\r'), std::string::npos);
}

TEST_F(Cli, AnOutputNeverOverwritesAnInput) {
  make_sample("a.obj", 3000);
  const std::string before = test::read_all(folder_ / "a.obj");
  EXPECT_EQ(run("mark --message x a.obj --out .").code, 2);
  EXPECT_EQ(run("mark --message x a.obj ./a.obj --out o").code, 2);
  EXPECT_EQ(run("mark --message x a.obj --out o --records a.obj").code, 2);
  EXPECT_EQ(test::read_all(folder_ / "a.obj"), before);
  EXPECT_FALSE(fs::exists(folder_ / "o"));
}

TEST_F(Cli, UnwritableOutputIsARecord) {
  make_sample("a.obj", 3000);
  folder_.write("o", "a file where the folder should be");
  const Result result = run("mark --message x a.obj --out o --json");
  EXPECT_EQ(result.code, 3);
  EXPECT_EQ(nlohmann::json::parse(result.out)["status"], "unwritable");
  EXPECT_EQ(run("mark --message x a.obj --out p --records /dev/full").code, 1);
}

TEST_F(Cli, ConfigFileStandsInForArguments) {
  make_sample("a.obj", 3000);
  folder_.write("c.toml", "[mark]\nmessage = \"from file\"\nout = \"o\"\n");
  const Result result = run("--config c.toml mark a.obj --json");
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(nlohmann::json::parse(result.out)["message_hex"], "66726f6d2066696c65");
}

TEST_F(Cli, MeasuresDistances) {
  make_sample("a.obj", 3000);
  ASSERT_EQ(run("mark --message x a.obj --out o").code, 0);
  const Result result = run("measure a.obj o/a.obj --json");
  ASSERT_EQ(result.code, 0);
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_TRUE(json["same_triangles"]);
  EXPECT_GT(json["hausdorff"], 0);
  EXPECT_LE(json["hausdorff"], json["displacement_max"]);
  EXPECT_EQ(nlohmann::json::parse(run("measure a.obj a.obj --json").out)["hausdorff"], 0);
  EXPECT_EQ(run("measure a.obj absent.obj").code, 2);
}

// A flux layer holds the number of a message that is too long for it; who hid it knows which.
TEST_F(Cli, ExtractTellsNumbersByTheLedgerAndByRecords) {
  const Mesh mesh = test::knobbly(50);
  OutputFile file(folder_ / "a.obj");
  file.write(export_mesh(mesh, {}));
  file.commit();
  ASSERT_EQ(run("mark a.obj --out o --scheme flux --message 'leak 4711' --records r.jsonl").code,
            0);
  const Result plain = run("extract o/a.obj --json");
  EXPECT_EQ(plain.code, 0) << plain.err;
  const auto json = nlohmann::json::parse(plain.out);
  EXPECT_EQ(json["scheme"], "flux");
  EXPECT_FALSE(json.contains("message_hex"));
  EXPECT_EQ(json["number"].get<std::string>().size(), json["payload_bits"].get<int>() / 4);
  EXPECT_NE(run("extract o/a.obj").out.find("number " + json["number"].get<std::string>()),
            std::string::npos);
  for (const char* memory : {"--ledger o.ledger", "--like r.jsonl"}) {
    const Result told = run(std::string("extract o/a.obj ") + memory);
    EXPECT_NE(told.out.find("\"leak 4711\"  flux"), std::string::npos) << memory << told.out;
  }
  EXPECT_EQ(run("verify r.jsonl").code, 0);
}

TEST_F(Cli, MeasuresWhatIsAskedFor) {
  make_sample("a.obj", 3000);
  make_sample("b.obj", 2000);
  ASSERT_EQ(run("mark --message x a.obj --out o").code, 0);
  const auto all = nlohmann::json::parse(run("measure a.obj o/a.obj --metric all --json").out);
  for (const char* name :
       {"hausdorff", "displacement_max", "metro_hausdorff", "mrms", "msdm", "msdm2",
        "roughness_increase", "strain", "normal_deviation_max_degrees", "snr_db"}) {
    EXPECT_TRUE(all[name].is_number()) << name;
  }
  EXPECT_LE(all["metro_hausdorff"], all["hausdorff"].get<double>() + 1e-5);
  const auto coarse = nlohmann::json::parse(run("measure a.obj b.obj --metric all --json").out);
  EXPECT_TRUE(coarse.contains("msdm2"));
  EXPECT_FALSE(coarse.contains("msdm"));
  const Result refused = run("measure a.obj b.obj --metric strain");
  EXPECT_EQ(refused.code, 2);
  EXPECT_NE(refused.err.find("strain"), std::string::npos);
  EXPECT_EQ(run("measure a.obj b.obj --metric beauty").code, 2);
  const auto rough = nlohmann::json::parse(run("measure a.obj b.obj --tolerance 0.01 --json").out);
  EXPECT_LE(rough["hausdorff_error"], 0.01 * rough["diagonal"].get<double>());
}

TEST_F(Cli, SamplesAreTheSameForTheSameSeed) {
  ASSERT_EQ(run("sample --out s --count 3 --triangles 2000 --seed 5").code, 0);
  ASSERT_EQ(run("sample --out t --count 3 --triangles 2000 --seed 5 --threads 1").code, 0);
  ASSERT_EQ(run("sample --out u --count 1 --triangles 2000 --seed 6 --format stl").code, 0);
  for (const char* name : {"0000-closed.obj", "0001-open.obj", "0002-high-genus.obj"}) {
    EXPECT_EQ(test::read_all(folder_ / "s" / name), test::read_all(folder_ / "t" / name));
    EXPECT_GT(fs::file_size(folder_ / "s" / name), 50000U);
  }
  EXPECT_TRUE(fs::exists(folder_ / "u/0000-closed.stl"));
}

TEST_F(Cli, InterruptLeavesWholeFilesAndExits130) {
  std::string manifest;
  for (int i = 0; i < 60; ++i) {
    const std::string name = "in/" + std::to_string(i) + ".obj";
    make_sample(name, 20000);
    manifest += "{\"mesh\": \"" + name + "\"}\n";
  }
  folder_.write("m.jsonl", manifest);
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    if (chdir(folder_.path().c_str()) != 0) _exit(9);
    if (freopen("/dev/null", "w", stderr) == nullptr) _exit(9);
    if (freopen("out.jsonl", "w", stdout) == nullptr) _exit(9);
    execl(TRIGLYPH_EXECUTABLE, "triglyph", "mark", "m.jsonl", "--message", "x", "--out", "o",
          "--json", "--threads", "2", nullptr);
    _exit(9);
  }
  // as soon as the first file is there, interrupt
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (test::read_all(folder_ / "out.jsonl").empty() &&
         std::chrono::steady_clock::now() < deadline) {
    usleep(1000);
  }
  kill(child, SIGINT);
  int status = 0;
  waitpid(child, &status, 0);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 130);
  std::size_t marked = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder_ / "o")) {
    if (!entry.is_regular_file()) continue;
    ++marked;
    EXPECT_EQ(entry.path().filename().string().front() == '.', false) << entry.path();
    EXPECT_EQ(run("extract '" + entry.path().string() + "'").code, 0);
  }
  EXPECT_GE(marked, 1U);
  EXPECT_LT(marked, 60U);
}

}  // namespace
}  // namespace triglyph
