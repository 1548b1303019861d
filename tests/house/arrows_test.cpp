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

using Rooms = std::set<std::string>;

// What a room may include beside itself; a room contains its sub-rooms.
const std::map<std::string, Rooms> kMayInclude{
    {"engine/base", {}},
    {"engine/geometry", {"engine/base"}},
    {"engine/mesh", {"engine/base", "engine/geometry"}},
    {"engine/io", {"engine/base", "engine/geometry", "engine/mesh"}},
    {"engine/samples", {"engine/base", "engine/geometry", "engine/mesh"}},
    {"engine/attack",
     {"engine/base", "engine/geometry", "engine/mesh", "engine/io", "engine/samples"}},
    {"engine/message", {"engine/base"}},
    {"engine/assignment", {"engine/base"}},
    {"engine/layout", {"engine/base"}},
    {"engine/metric", {"engine/base", "engine/geometry", "engine/mesh"}},
    {"engine/flux",
     {"engine/base", "engine/geometry", "engine/mesh", "engine/message", "engine/metric"}},
    {"engine/scheme",
     {"engine/base", "engine/geometry", "engine/mesh", "engine/message", "engine/assignment"}},
    {"engine/align", {"engine/base", "engine/geometry", "engine/mesh"}},
    {"engine/trace",
     {"engine/base", "engine/mesh", "engine/message", "engine/scheme", "engine/flux"}},
    {"engine/marking",
     {"engine/base", "engine/geometry", "engine/mesh", "engine/io", "engine/message",
      "engine/scheme", "engine/layout", "engine/assignment", "engine/metric", "engine/flux",
      "engine/align", "engine/trace"}},
    {"engine/survival",
     {"engine/base", "engine/geometry", "engine/mesh", "engine/attack", "engine/message",
      "engine/scheme", "engine/flux", "engine/trace", "engine/marking", "engine/metric"}},
    {"manifests", {"engine"}},
    {"cli", {"manifests", "engine"}},
    {"cli/manual", {"cli", "render"}},
    {"render", {"engine"}}};

// Is `folder` the room, or one inside it?
bool lies_in(const std::string& folder, const std::string& room) {
  return folder == room || folder.rfind(room + "/", 0) == 0;
}

// The innermost room.
std::string room_of(const std::string& folder) {
  std::string found;
  for (const auto& [room, allowed] : kMayInclude) {
    if (lies_in(folder, room) && room.size() > found.size()) found = room;
  }
  return found.empty() ? folder : found;
}

bool is_source(const fs::directory_entry& entry) {
  return entry.path().extension() == ".h" || entry.path().extension() == ".cpp";
}

TEST(Arrows, IncludesPointOneWay) {
  std::size_t seen = 0;
  for (const char* top : {"engine", "manifests", "cli", "render"}) {
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(TRIGLYPH_SOURCE) / top)) {
      if (!is_source(entry)) continue;
      const fs::path name = entry.path().lexically_relative(TRIGLYPH_SOURCE);
      const std::string room = room_of(name.parent_path().string());
      ASSERT_EQ(kMayInclude.count(room), 1U) << name << " lies in no room";
      const Rooms& allowed = kMayInclude.at(room);
      std::istringstream lines(test::read_all(entry.path()));
      for (std::string line; std::getline(lines, line);) {
        if (line.rfind("#include \"", 0) != 0) continue;
        const std::string target = line.substr(10, line.find('"', 10) - 10);
        const std::string to = fs::path(target).parent_path().string();
        const bool may = std::any_of(allowed.begin(), allowed.end(),
                                     [&](const std::string& other) { return lies_in(to, other); });
        EXPECT_TRUE(may || lies_in(to, room)) << name << " includes " << target;
        ++seen;
      }
    }
  }
  EXPECT_GT(seen, 100U);
}

// What connectivity is made of is nobody else's business, but of the one who changes a copy of it.
TEST(Arrows, OnlyHalfedgesAndWhoChangesThemNameTheirKernel) {
  const std::set<std::string> doors{"engine/mesh/halfedges.h", "engine/mesh/halfedges.cpp",
                                    "engine/attack/isotropic_remesh.cpp"};
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(TRIGLYPH_SOURCE) / "engine")) {
    if (!is_source(entry)) continue;
    const std::string name = entry.path().lexically_relative(TRIGLYPH_SOURCE).string();
    EXPECT_TRUE(test::read_all(entry.path()).find("OpenMesh::") == std::string::npos ||
                doors.count(name) != 0)
        << name << " names OpenMesh";
  }
}

// Each library has one door.
TEST(Arrows, LibrariesStayInTheirRooms) {
  const std::map<std::string, std::set<std::string>> doors{
      {"<tbb/", {"engine/base/parallel.h", "manifests/flow.cpp"}},
      {"<Eigen/",
       {"engine/geometry/symmetric_matrix.cpp", "engine/flux/flux_embedding.cpp",
        "engine/flux/thin_plate.cpp", "engine/align/alignment.cpp", "engine/align/similarity.cpp"}},
      {"<embree3/", {"engine/geometry/embree_device.h"}},
      {"<OpenImageIO/", {"render/picture_file.cpp"}},
      {"<CLI/",
       {"cli/config.h", "cli/options.h", "cli/verbs.h", "cli/manual/man_page.h",
        "cli/manual/completion.h", "cli/run_arguments.h", "render/arguments.h"}},
      {"<OpenMesh/", {"engine/mesh/halfedges.h"}},
      {"<meshoptimizer",
       {"engine/mesh/fewer_triangles.cpp", "engine/io/packed_mesh.cpp",
        "engine/io/gltf_compression.cpp"}},
      {"<draco/", {"engine/io/gltf_compression.cpp"}},
      {"<simdjson", {"engine/io/gltf_json.h", "engine/io/rewrite_gltf.cpp"}},
      {"<sqlite3", {"manifests/ledger.cpp"}},
      {"<sodium", {"engine/message/key.cpp", "engine/io/base64.cpp"}}};
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
