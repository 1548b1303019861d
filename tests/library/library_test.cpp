// The shared library through its public header alone.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <triglyph/triglyph.h>

#include "tests/support/temp_folder.h"

namespace triglyph {
namespace {

namespace fs = std::filesystem;

class Library : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::string command = "'" TRIGLYPH_EXECUTABLE
                                "' sample --shape closed --triangles 6000 --out '" +
                                folder_.path().string() + "' >/dev/null";
    ASSERT_EQ(std::system(command.c_str()), 0);
    for (const auto& entry : fs::directory_iterator(folder_.path())) mesh_ = entry.path();
    out_ = folder_.path() / "marked.obj";
  }

  test::TempFolder folder_;
  fs::path mesh_;
  fs::path out_;
};

TEST_F(Library, ReadsAndVerifiesWhatItMarked) {
  const SecretKey key = SecretKey::generate();
  const MarkReport marked =
      mark_file(mesh_, out_, {{"message", "for Ada"}, {"scheme", "aie"}, {"detail", "true"}}, key);
  ASSERT_TRUE(marked.marked) << marked.error;
  EXPECT_EQ(marked.status, "marked");
  EXPECT_GT(marked.units, 0U);
  EXPECT_GT(marked.hausdorff_rel_diag, 0);
  EXPECT_LT(marked.hausdorff_rel_diag, 0.02);

  const std::vector<SecretKey> keys{SecretKey::trial(), key};
  const ReadReport found = read_file(out_, keys);
  EXPECT_EQ(found.message, "for Ada");
  EXPECT_EQ(found.scheme, "aie");
  EXPECT_EQ(found.key, 1U);
  EXPECT_LT(found.false_alarm, 1e-5);
  EXPECT_FALSE(read_file(mesh_, keys).message);

  EXPECT_EQ(verify_file(marked.record, key).verdict, "intact");
  const VerifyReport other_key = verify_file(marked.record, SecretKey::trial());
  EXPECT_EQ(other_key.verdict, "mark lost");
  EXPECT_NE(other_key.detail.find("another key"), std::string::npos);
  std::ofstream(out_, std::ios::app) << "# a line more\n";
  EXPECT_EQ(verify_file(marked.record, key).verdict, "altered, mark present");
  fs::remove(out_);
  EXPECT_EQ(verify_file(marked.record, key).verdict, "missing");
}

TEST_F(Library, KeysAreKeptInFiles) {
  const SecretKey key = SecretKey::generate();
  key.save(folder_.path() / "owner.key");
  EXPECT_EQ(SecretKey::load(folder_.path() / "owner.key").fingerprint(), key.fingerprint());
  EXPECT_NE(key.fingerprint(), SecretKey::trial().fingerprint());
  EXPECT_THROW(key.save(folder_.path() / "owner.key"), Error);
  EXPECT_THROW((void)SecretKey::load(folder_.path() / "absent.key"), Error);
}

TEST_F(Library, RefusesWhatMakesNoSense) {
  const SecretKey key = SecretKey::trial();
  const auto refused = [&](const Settings& settings) {
    try {
      (void)mark_file(mesh_, out_, settings, key);
    } catch (const Error& error) {
      return error.code() == ErrorCode::Usage ? std::string(error.what()) : "another code";
    }
    return std::string("nothing was thrown");
  };
  EXPECT_NE(refused({{"mesage", "a"}}).find("mesage"), std::string::npos);
  EXPECT_NE(refused({{"message", "a"}, {"max_move", "500"}}).find("max_move"), std::string::npos);
  EXPECT_NE(refused({{"message", "a"}, {"fill", "true"}}).find("fill"), std::string::npos);
  EXPECT_NE(refused({}).find("message"), std::string::npos);
  EXPECT_THROW((void)mark_file(mesh_, mesh_, {{"message", "a"}}, key), Error);
  EXPECT_THROW((void)read_file(mesh_, {}), Error);
  EXPECT_THROW((void)verify_file("{}", key), Error);
  EXPECT_FALSE(fs::exists(out_));

  const MarkReport absent = mark_file(folder_.path() / "absent.obj", out_, {{"message", "a"}}, key);
  EXPECT_FALSE(absent.marked);
  EXPECT_EQ(absent.status, "unreadable");
  EXPECT_NE(absent.error.find("absent.obj"), std::string::npos);
}

TEST(LibrarySettings, NameEveryOptionOfMark) {
  const std::vector<SettingInfo> all = mark_settings();
  EXPECT_GT(all.size(), 15U);
  for (const SettingInfo& setting : all) EXPECT_FALSE(setting.help.empty()) << setting.key;
  EXPECT_EQ(version(), "0.1.0");
}

}  // namespace
}  // namespace triglyph
