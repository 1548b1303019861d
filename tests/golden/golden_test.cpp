// Marks that older builds made must stay readable: the small files of this folder are never made
// anew, and the real executable must read from them what the table says. README.md tells how they
// came to be.
#include <cstdlib>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>

#include "tests/support/temp_folder.h"

namespace triglyph {
namespace {

namespace fs = std::filesystem;

struct GoldenMark {
  std::string_view file;
  std::string_view options;      // of extract
  std::string_view message_hex;  // empty: filled, no message to extract
};

constexpr GoldenMark kGoldenMarks[] = {
    // generation 1
    {"tsq-text.obj", "", "747371"},
    {"tsq-binary.stl", "", "416461"},
    {"aie-text.ply", "", "616965"},
    {"aie-binary.ply", "", "00ff017f"},
    {"aie-flat.ply", "", "666c6174"},
    {"iie-text.off", "", "69"},
    {"iie-binary.ply", "", "6969"},
    {"tsq-wide.off", "--scheme tsq --step 0.03 --part-bits 12", "77696465"},
    {"tsq-fill.obj", "", ""},
    {"aie-all.obj", "--scheme aie --aie-groups all", "616c6c"},
    {"iie-radius.ply", "--scheme iie --radius 0.28", "72"},
    {"flux-text.off", "", "6f6b"},
    {"flux-open.off", "", "6f6b"},
    {"owner.stl", "--scheme tsq --key-file owner.key", "6d696e65"},
    // generation 2
    {"iie-local.off", "", "6c"},
    {"iie-local.ply", "", "00ff01"},
    {"tsq-strong.obj", "", "77696465"},
    {"tsq-parity.obj", "", "706172697479"},
    {"iie-local-wide.obj", "--scheme iie --step 0.004 --site-rings 6 --part-bits 2", "77"},
};

struct GoldenRecords {
  std::string_view file;
  std::string_view options;  // of verify
};

constexpr GoldenRecords kGoldenRecords[] = {
    {"records.jsonl", ""},           {"flux-records.jsonl", ""},
    {"flux-open-records.jsonl", ""}, {"strong-records.jsonl", ""},
    {"records-2.jsonl", ""},         {"owner-records.jsonl", "--key-file owner.key"},
};

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

// The text under a key of a JSON object; empty if there is none.
std::string value_of(const std::string& line, const char* key) {
  const auto json = nlohmann::json::parse(line, nullptr, false);
  if (!json.is_object() || !json.contains(key) || !json[key].is_string()) return "";
  return json[key].get<std::string>();
}

bool is_mesh(const fs::path& path) {
  static const std::set<std::string> kExtensions{".obj", ".off", ".ply", ".stl"};
  return kExtensions.count(path.extension().string()) != 0;
}

// Works in a copy of the folder, so that nothing can change the golden files.
class GoldenMarks : public testing::Test {
 protected:
  struct Result {
    int code = 0;
    std::string out;
    std::string err;
  };

  GoldenMarks() {
    for (const auto& entry : fs::directory_iterator(source_)) {
      if (entry.is_regular_file()) fs::copy_file(entry, copy() / entry.path().filename());
    }
    // a checkout leaves it open to others, and then it is refused
    fs::permissions(copy() / "owner.key", fs::perms::owner_read | fs::perms::owner_write);
  }

  [[nodiscard]] fs::path copy() const { return folder_.path(); }

  [[nodiscard]] Result run(const std::string& arguments) const {
    const std::string command = "cd '" + copy().string() + "' && '" TRIGLYPH_EXECUTABLE "' " +
                                arguments + " >.out 2>.err </dev/null";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128, test::read_all(folder_ / ".out"),
            test::read_all(folder_ / ".err")};
  }

  const fs::path source_ = fs::path(TRIGLYPH_SOURCE) / "tests" / "golden";

 private:
  test::TempFolder folder_;
};

TEST_F(GoldenMarks, MarksOfOlderBuildsStayReadable) {
  for (const GoldenMark& mark : kGoldenMarks) {
    if (mark.message_hex.empty()) continue;
    const std::string arguments =
        "extract --json " + std::string(mark.file) + " " + std::string(mark.options);
    const Result result = run(arguments);
    EXPECT_EQ(result.code, 0) << arguments << "\n" << result.err;
    EXPECT_EQ(value_of(result.out, "status"), "marked") << arguments << "\n" << result.out;
    EXPECT_EQ(value_of(result.out, "message_hex"), mark.message_hex) << arguments;
  }
}

TEST_F(GoldenMarks, CopiesOfOlderBuildsAreStillTraced) {
  fs::copy(source_ / "copies", copy() / "copies");
  for (const char* file : {"flux.off", "units.ply", "small.stl", "box.obj"}) {
    const std::string arguments =
        "trace --json copies/" + std::string(file) + " --recipients copies/recipients.txt" +
        (std::string(file) == "box.obj" ? " --original copies/box-original.obj" : "");
    const Result result = run(arguments);
    EXPECT_EQ(result.code, 0) << arguments << "\n" << result.out << result.err;
    const auto json = nlohmann::json::parse(result.out, nullptr, false);
    ASSERT_TRUE(json.is_object() && !json["names"].empty()) << result.out;
    EXPECT_EQ(json["names"][0]["name"], "Ada") << arguments;
    EXPECT_TRUE(json["names"][0]["is_believed"].get<bool>()) << arguments;
    if (json["names"].size() > 1) {
      EXPECT_FALSE(json["names"][1]["is_believed"].get<bool>()) << arguments;
    }
  }
}

TEST_F(GoldenMarks, RecordsOfOlderBuildsStillVerify) {
  for (const GoldenRecords& records : kGoldenRecords) {
    const std::string arguments =
        "verify --json " + std::string(records.file) + " " + std::string(records.options);
    const Result result = run(arguments);
    EXPECT_EQ(result.code, 0) << arguments << "\n" << result.err;
    const auto recorded = lines_of(test::read_all(copy() / records.file));
    const auto verified = lines_of(result.out);
    ASSERT_EQ(verified.size(), recorded.size()) << arguments << "\n" << result.err;
    for (std::size_t i = 0; i < recorded.size(); ++i) {
      EXPECT_EQ(value_of(verified[i], "verdict"), "intact")
          << records.file << ", line " << i + 1 << ": " << verified[i];
    }
  }
}

TEST_F(GoldenMarks, EveryGoldenFileIsInTheTableAndInTheRecords) {
  std::set<std::string> present, expected, recorded;
  for (const auto& entry : fs::directory_iterator(source_)) {
    if (is_mesh(entry.path())) present.insert(entry.path().filename().string());
  }
  for (const GoldenMark& mark : kGoldenMarks) expected.emplace(mark.file);
  recorded.emplace("tsq-parity.obj");  // was attacked: no record says that it is intact
  for (const GoldenRecords& records : kGoldenRecords) {
    for (const std::string& line : lines_of(test::read_all(source_ / records.file))) {
      recorded.insert(fs::path(value_of(line, "out")).lexically_normal().string());
    }
  }
  EXPECT_EQ(present, expected);
  EXPECT_EQ(recorded, expected);
}

}  // namespace
}  // namespace triglyph
