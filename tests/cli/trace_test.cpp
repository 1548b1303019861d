// Copies for recipients and whose copy turns up, as a user sees it.
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/cli/cli_fixture.h"

namespace triglyph {
namespace {

using TraceCli = test::CliTest;

TEST_F(TraceCli, SaysWhoseCopyAFileIs) {
  make_sample("in/a.obj", 3000);
  make_sample("in/b.obj", 1500, 2);
  folder_.write("buyers.csv", "name,mail\nAda,a@x\n\"Ben, Ltd.\",b@x\nCem,c@x\n");
  const auto marked = run("mark in --out copies --recipients buyers.csv --json");
  ASSERT_EQ(marked.code, 0) << marked.err;
  EXPECT_NE(marked.err.find("6 meshes: 6 traceable"), std::string::npos) << marked.err;
  EXPECT_NE(marked.out.find("\"recipient\":\"Ben, Ltd.\""), std::string::npos);
  ASSERT_TRUE(std::filesystem::exists(folder_ / "copies/Ben, Ltd%2e/b.obj") ||
              std::filesystem::exists(folder_ / "copies/Ben%2c Ltd%2e/b.obj"));
  const auto traced =
      run("trace copies/Cem in/a.obj 'copies/Ben%2c Ltd%2e/b.obj' --ledger copies.ledger --json");
  EXPECT_EQ(traced.code, 4) << traced.err;
  std::istringstream lines(traced.out);
  std::vector<nlohmann::json> all;
  for (std::string line; std::getline(lines, line);) all.push_back(nlohmann::json::parse(line));
  ASSERT_EQ(all.size(), 4U) << traced.out;
  EXPECT_EQ(all[0]["names"][0]["name"], "Cem");
  EXPECT_EQ(all[1]["names"][0]["name"], "Cem");
  EXPECT_EQ(all[2]["status"], "nobody");
  EXPECT_EQ(all[3]["names"][0]["name"], "Ben, Ltd.");
  EXPECT_TRUE(all[3]["names"][0]["is_believed"].get<bool>());
  EXPECT_EQ(all[3]["candidates"], 3);
  const auto text = run("trace copies/Ada/a.obj --recipients buyers.csv");
  EXPECT_EQ(text.code, 0) << text.err;
  EXPECT_NE(text.out.find("copies/Ada/a.obj: \"Ada\"  false alarm 2^-"), std::string::npos)
      << text.out;
  const auto again = run("mark in --out copies --recipients buyers.csv");
  EXPECT_NE(again.err.find("6 as an earlier run left them"), std::string::npos) << again.err;
  const auto verified = run("verify --ledger copies.ledger");
  EXPECT_EQ(verified.code, 0) << verified.out << verified.err;
}

TEST_F(TraceCli, AMessageInALedgerIsTracedToo) {
  make_sample("a.obj", 3000);
  ASSERT_EQ(run("mark a.obj --out out --message 'for Ada' --scheme tsq").code, 0);
  const auto traced = run("trace out/a.obj --ledger out.ledger");
  EXPECT_EQ(traced.code, 0) << traced.err;
  EXPECT_NE(traced.out.find("the message \"for Ada\""), std::string::npos) << traced.out;
}

TEST_F(TraceCli, RefusesInOneLine) {
  make_sample("a.obj", 1000);
  folder_.write("twice.txt", "Ada\nAda\n");
  folder_.write("list.txt", "Ada\n");
  const std::pair<const char*, const char*> kWrong[] = {
      {"trace a.obj", "nobody to look for"},
      {"trace a.obj --ledger list.txt", "is no ledger"},
      {"trace a.obj --recipients twice.txt", "line 2"},
      {"trace a.obj --recipients list.txt --false-alarm 2", "--false-alarm"},
      {"mark a.obj --out o --recipients absent.txt", "cannot be read"},
      {"mark a.obj --out o --recipients list.txt --message m", "exclude each other"},
      {"mark a.obj --out o --message m --collusion 3", "collusion is of copies"},
      {"mark a.obj --out o --recipient ''", "1 to 256 bytes"}};
  for (const auto& [arguments, reason] : kWrong) {
    const auto result = run(arguments);
    EXPECT_EQ(result.code, 2) << arguments << ": " << result.err;
    EXPECT_NE(result.err.find(reason), std::string::npos) << arguments << ": " << result.err;
  }
}

}  // namespace
}  // namespace triglyph
