#include "engine/base/output_file.h"

#include <csignal>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

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

// What a process leaves that was killed while it wrote is gone when another writes there, and
// nothing else is: no file that somebody is writing, and none that only looks similar.
TEST(OutputFile, RemovesWhatKilledProcessesLeft) {
  const test::TempFolder folder;
  const pid_t child = fork();
  if (child == 0) {
    OutputFile file(folder / "killed.obj");
    file.write(std::string("half"));
    std::raise(SIGKILL);
  }
  waitpid(child, nullptr, 0);
  ASSERT_EQ(files_in(folder.path()), 1U);
  const auto of_the_past = folder.write(".a.b.77-3.part", "without an extension");
  const std::vector<std::string> others = {
      ".part.obj", ".a.part.obj",  ".a.1-2.part.obj.txt", "a.1-2.part.obj",
      ".1-2.part", ".a.1-2.parts", ".a.1-two.part.obj",   ".a.-2.part"};
  for (const std::string& name : others) folder.write(name, "");
  int ready[2] = {};
  int done[2] = {};
  ASSERT_EQ(pipe(ready) + pipe(done), 0);
  const pid_t writer = fork();
  if (writer == 0) {
    close(done[1]);
    OutputFile file(folder / "living.obj");
    char byte = 0;
    const bool told = write(ready[1], &byte, 1) == 1;
    if (!told || read(done[0], &byte, 1) != 0) _exit(2);
    file.commit();
    _exit(0);
  }
  close(done[0]);
  char byte = 0;
  ASSERT_EQ(read(ready[0], &byte, 1), 1);
  { const OutputFile file(folder / "a.obj"); }
  EXPECT_FALSE(std::filesystem::exists(of_the_past));
  EXPECT_EQ(files_in(folder.path()), others.size() + 1);
  for (const std::string& name : others)
    EXPECT_TRUE(std::filesystem::exists(folder / name)) << name;
  close(done[1]);
  int status = -1;
  waitpid(writer, &status, 0);
  EXPECT_EQ(status, 0);
  EXPECT_TRUE(std::filesystem::exists(folder / "living.obj"));
}

}  // namespace
}  // namespace triglyph
