// The house's arrows: cli -> manifests -> engine, and inside the engine from the whole to the
// parts.
#include <algorithm>
#include <map>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/temp_folder.h"

namespace triglyph {
namespace {

namespace fs = std::filesystem;

// What a folder may include beside itself.
const std::map<std::string, std::set<std::string>> kMayInclude{
    {"engine/base", {}},
    {"engine/mesh", {"engine/base"}},
    {"engine/message", {"engine/base"}},
    {"engine/assignment", {"engine/base"}},
    {"engine/scheme", {"engine/base", "engine/mesh", "engine/message", "engine/assignment"}},
    {"engine/layout", {"engine/base", "engine/scheme"}},
    {"engine/metric", {"engine/base", "engine/mesh"}},
    {"engine",
     {"engine/base", "engine/mesh", "engine/message", "engine/scheme", "engine/layout",
      "engine/assignment", "engine/metric"}},
    {"manifests",
     {"engine", "engine/base", "engine/mesh", "engine/message", "engine/metric", "engine/scheme"}},
    {"cli", {"manifests", "engine/base", "engine/mesh", "engine/message", "engine/metric"}},
    {"render", {"engine", "engine/base", "engine/mesh", "engine/metric", "engine/scheme"}}};

TEST(Arrows, IncludesPointOneWay) {
  std::size_t seen = 0;
  for (const auto& [folder, allowed] : kMayInclude) {
    for (const auto& entry : fs::directory_iterator(fs::path(TRIGLYPH_SOURCE) / folder)) {
      if (entry.path().extension() != ".h" && entry.path().extension() != ".cpp") continue;
      std::istringstream lines(test::read_all(entry.path()));
      for (std::string line; std::getline(lines, line);) {
        if (line.rfind("#include \"", 0) != 0) continue;
        const std::string name = line.substr(10, line.find('"', 10) - 10);
        const std::string from = fs::path(name).parent_path().string();
        EXPECT_TRUE(from == folder || allowed.count(from) != 0)
            << entry.path() << " includes " << name;
        ++seen;
      }
    }
  }
  EXPECT_GT(seen, 100U);
}

// Each library has one door.
TEST(Arrows, LibrariesStayInTheirRooms) {
  const std::map<std::string, std::set<std::string>> doors{
      {"<tbb/", {"engine/base/parallel.h", "manifests/run.cpp"}},
      {"<Eigen/", {"engine/mesh/symmetric_matrix.cpp"}},
      {"<embree3/", {"engine/mesh/embree_device.h"}},
      {"<OpenImageIO/", {"render/picture_file.cpp"}},
      {"<CLI/", {"cli/options.h", "cli/verbs.h", "render/app.cpp"}},
      {"<OpenMesh/", {"engine/mesh/halfedges.h", "engine/mesh/vec3.h"}},
      {"<sodium", {"engine/message/key.cpp"}}};
  for (const char* room : {"engine", "manifests", "cli", "render"}) {
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(TRIGLYPH_SOURCE) / room)) {
      if (!entry.is_regular_file()) continue;
      const std::string text = test::read_all(entry.path());
      const std::string name = entry.path().lexically_relative(TRIGLYPH_SOURCE).string();
      for (const auto& [include, files] : doors) {
        EXPECT_TRUE(text.find("#include " + include) == std::string::npos || files.count(name) != 0)
            << name << " includes " << include;
      }
    }
  }
}

}  // namespace
}  // namespace triglyph
