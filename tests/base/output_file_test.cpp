#include "engine/base/output_file.h"

#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "tests/support/temp_folder.h"

namespace triglyph {
namespace {

std::size_t files_in(const std::filesystem::path& folder) {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

TEST(OutputFile, AppearsWholeAtCommit) {
  const test::TempFolder folder;
  OutputFile file(folder / "new/deep/a.obj");
  file.write(std::string("v 1 2 3\n"));
  EXPECT_FALSE(std::filesystem::exists(folder / "new/deep/a.obj"));
  EXPECT_EQ(file.temporary_path().extension(), ".obj");
  EXPECT_EQ(test::read_all(file.temporary_path()), "v 1 2 3\n");
  file.commit();
  EXPECT_EQ(test::read_all(folder / "new/deep/a.obj"), "v 1 2 3\n");
  EXPECT_EQ(files_in(folder / "new/deep"), 1U);
}

TEST(OutputFile, LeavesNothingAndKeepsTheOldWithoutCommit) {
  const test::TempFolder folder;
  folder.write("a.obj", "old");
  { OutputFile(folder / "a.obj").write(std::string("new")); }
  EXPECT_EQ(test::read_all(folder / "a.obj"), "old");
  EXPECT_EQ(files_in(folder.path()), 1U);
}

TEST(OutputFile, FullDiskAndImpossiblePlacesAreErrors) {
  const test::TempFolder folder;
  const auto file = folder.write("file", "");
  EXPECT_THROW(OutputFile(file / "a.obj"), Error);  // a file is in the way of the directory
  std::filesystem::create_directory(folder / "taken");
  OutputFile output(folder / "taken");
  EXPECT_THROW(output.commit(), Error);  // a directory stands at the name
  EXPECT_THROW(OutputFile("/proc/no/such/place"), Error);
}

}  // namespace
}  // namespace triglyph
