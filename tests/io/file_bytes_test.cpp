#include "engine/io/file_bytes.h"

#include <filesystem>
#include <fstream>
#include <string>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "engine/base/error.h"
#include "engine/io/mesh_file.h"

namespace triglyph {
namespace {

class Files : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (std::filesystem::temp_directory_path() / "triglyph-test-XXXXXX").string();
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }
  static std::string reason(const std::filesystem::path& path) {
    try {
      (void)MeshFile::open(path);
      return "opened";
    } catch (const Error& error) {
      return error.code() == ErrorCode::Unreadable ? error.message() : "another error";
    }
  }

  std::filesystem::path folder_;
};

TEST_F(Files, AreReadAsTheyAre) {
  const auto path = write("a.obj", "v 1 2 3\n");
  FileBytes file = FileBytes::open(path);
  const FileBytes moved = std::move(file);
  EXPECT_EQ(std::string(moved.bytes().begin(), moved.bytes().end()), "v 1 2 3\n");
  EXPECT_EQ(MeshFile::open(path).vertex_count(), 1U);
}

TEST_F(Files, AreRefusedWithTheReason) {
  EXPECT_EQ(reason(folder_ / "none.obj"), "cannot open: No such file or directory");
  EXPECT_EQ(reason(folder_), "is a directory, not a regular file");
  EXPECT_EQ(reason(write("empty.obj", "")), "is empty");
  EXPECT_EQ(reason("/dev/null"), "is not a regular file");
}

// What happens to a file of which another process cuts off a part, or to which it appends.
TEST_F(Files, AreRefusedIfTheirSizeChanges) {
  const auto path = write("a.obj", std::string(10'000'000, '#'));
  const int descriptor = ::open(path.c_str(), O_RDONLY);
  ASSERT_GE(descriptor, 0);
  const auto reason_for = [&](std::size_t size) -> std::string {
    try {
      (void)FileBytes::read(descriptor, size, path);
      return "read";
    } catch (const Error& error) {
      return error.code() == ErrorCode::Unreadable ? error.message() : "another error";
    }
  };
  EXPECT_EQ(reason_for(10'000'000), "read");
  EXPECT_EQ(reason_for(10'000'001), "was truncated while it was read");
  EXPECT_EQ(reason_for(50'000'000), "was truncated while it was read");
  EXPECT_EQ(reason_for(9'999'999), "grew while it was read");
  ::close(descriptor);
  EXPECT_EQ(reason_for(10'000'000), "cannot read: Bad file descriptor");
}

TEST_F(Files, StayInMemoryWhenTheyAreCutOff) {
  const auto path = write("a.obj", std::string(1'000'000, '#'));
  const FileBytes file = FileBytes::open(path);
  std::filesystem::resize_file(path, 1);
  EXPECT_EQ(file.bytes().back(), '#');
}

TEST_F(Files, DoNotWaitForAPipe) {
  const auto path = folder_ / "pipe.obj";
  ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
  EXPECT_EQ(reason(path), "is not a regular file");
}

TEST_F(Files, NeedPermission) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may read everything";
  const auto path = write("secret.obj", "v 1 2 3\n");
  ASSERT_EQ(::chmod(path.c_str(), 0), 0);
  EXPECT_EQ(reason(path), "cannot open: Permission denied");
}

TEST_F(Files, NeedAKnownEnding) {
  try {
    (void)MeshFile::open(write("a.xyz", "{}"));
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::Unsupported);
    EXPECT_NE(std::string(error.what()).find(".xyz"), std::string::npos);
  }
}

}  // namespace
}  // namespace triglyph
