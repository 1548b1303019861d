// Marking in shards, and merging them.
#include <algorithm>
#include <sstream>

#include "manifests/json_line.h"
#include "tests/cli/cli_fixture.h"

namespace triglyph {
namespace {

class ShardCli : public test::CliTest {
 protected:
  void SetUp() override {
    for (int i = 0; i < 6; ++i) {
      make_sample("in/" + std::to_string(i) + ".obj", 600, static_cast<std::uint64_t>(i));
    }
  }
  [[nodiscard]] test::CliResult mark(const std::string& more) const {
    return run("mark in --out lib --scheme tsq --message hi --records run.jsonl --quiet " + more);
  }
  [[nodiscard]] std::string records_without_run(const std::string& name) const {
    std::string text;
    std::istringstream lines(test::read_all(folder_ / name));
    for (std::string line; std::getline(lines, line);) {
      nlohmann::ordered_json json = parse_json_line(line);
      json.erase("run");
      text += to_line(json);
    }
    return text;
  }
};

TEST_F(ShardCli, MergedShardsAreTheRun) {
  for (const char* shard : {"1/3", "2/3", "3/3"}) {
    EXPECT_EQ(mark(std::string("--shard ") + shard).code, 0);
  }
  const test::CliResult partly =
      run("merge lib.shard-1-of-3.ledger lib.shard-3-of-3.ledger run.shard-1-of-3.jsonl "
          "run.shard-3-of-3.jsonl --ledger some.ledger --records some.jsonl");
  EXPECT_EQ(partly.code, 3);
  EXPECT_NE(partly.err.find("no records of places "), std::string::npos) << partly.err;
  const test::CliResult merged =
      run("merge lib.shard-*.ledger run.shard-*.jsonl --ledger lib.ledger --records run.jsonl");
  EXPECT_EQ(merged.code, 0) << merged.err;
  EXPECT_EQ(merged.out, "6 records merged\n3 ledgers merged\n");
  const std::string records = records_without_run("run.jsonl");
  EXPECT_EQ(run("sweep --ledger lib.ledger").code, 0);
  // the whole run finds all done, and again in a shard of its own
  const test::CliResult again = run("mark in --out lib --scheme tsq --message hi");
  EXPECT_NE(again.err.find("6 as an earlier run left them"), std::string::npos) << again.err;
  std::filesystem::remove(folder_ / "lib.shard-1-of-3.ledger");
  const test::CliResult shard = run("mark in --out lib --scheme tsq --message hi --shard 1/3");
  EXPECT_NE(shard.err.find("2 as an earlier run left them"), std::string::npos) << shard.err;
  std::filesystem::remove_all(folder_ / "lib");
  std::filesystem::remove(folder_ / "lib.ledger");
  ASSERT_EQ(mark("").code, 0);
  EXPECT_EQ(records_without_run("run.jsonl"), records);
}

TEST_F(ShardCli, RefusesInOneLine) {
  ASSERT_EQ(mark("").code, 0);
  for (const char* arguments :
       {"mark in --out lib --message hi --shard 4/3", "merge run.jsonl",
        "merge run.jsonl --records run.jsonl", "merge lib.ledger --ledger lib.ledger",
        "merge absent.jsonl --records out.jsonl", "merge in/0.obj --records out.jsonl",
        "merge run.jsonl --records out.jsonl --ledger out.ledger"}) {
    const test::CliResult result = run(std::string(arguments) + " 2>&1 | grep -v warning");
    EXPECT_EQ(std::count(result.out.begin(), result.out.end(), '\n'), 1) << result.out;
    EXPECT_EQ(run(arguments).code, 2) << arguments;
  }
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out.jsonl"));
}

}  // namespace
}  // namespace triglyph
