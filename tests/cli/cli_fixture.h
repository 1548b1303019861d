// Runs the real executable as a user does, in a folder of its own.
#pragma once

#include <cstdlib>
#include <string>

#include <gtest/gtest.h>
#include <sys/wait.h>

#include "engine/base/output_file.h"
#include "engine/io/export_mesh.h"
#include "engine/samples/sample_shapes.h"
#include "tests/support/temp_folder.h"

namespace triglyph::test {

struct CliResult {
  int code = 0;
  std::string out;
  std::string err;
};

class CliTest : public testing::Test {
 protected:
  // Arguments are words for the shell, which may redirect; `environment` is put before the command.
  // The folder of the test is the working directory.
  [[nodiscard]] CliResult run(const std::string& arguments,
                              const std::string& environment = "") const {
    const std::string command = "cd '" + folder_.path().string() + "' && { " + environment +
                                " '" TRIGLYPH_EXECUTABLE "' " + arguments +
                                " ; } >.out 2>.err </dev/null";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128, read_all(folder_ / ".out"),
            read_all(folder_ / ".err")};
  }

  void make_sample(const std::string& name, std::size_t triangles, std::uint64_t seed = 1) const {
    OutputFile file(folder_ / name);
    file.write(export_mesh(make_sample_shape(SampleShape::Closed, triangles, seed), {}));
    file.commit();
  }

  TempFolder folder_;
};

}  // namespace triglyph::test
