// Readers of mesh files. The first byte chooses the format; the rest is the file. What was read can
// be patched and read again, with the same number of vertices and faces, unless it says why not.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "engine/base/error.h"
#include "engine/io/mesh_file.h"
#include "tests/fuzz/fuzz.h"

namespace {

using triglyph::MeshFile;
using triglyph::Vec3;
using triglyph::fuzz::expect;

void round_trip(const MeshFile& file, const char* name) {
  const std::vector<Vec3>& before = file.mesh().positions;
  const std::vector<char> same = file.patched(before);
  expect(std::equal(same.begin(), same.end(), file.bytes().begin(), file.bytes().end()));
  std::vector<Vec3> moved = before;
  for (Vec3& point : moved) point = file.round(point * 1.01);
  const bool is_finite = std::all_of(moved.begin(), moved.end(), [](const Vec3& point) {
    return std::isfinite(point[0]) && std::isfinite(point[1]) && std::isfinite(point[2]);
  });
  if (!is_finite) return;
  const MeshFile again = MeshFile::read(file.patched(moved), name);
  expect(again.vertex_count() == file.vertex_count());
  expect(again.face_count() == file.face_count());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::array kNames = {"a.obj", "a.off", "a.ply", "a.stl"};
  if (size == 0) return 0;
  const char* name = data[0] < 128 ? kNames[data[0] % kNames.size()] : "a.gltf";
  const std::string_view text = triglyph::fuzz::text_of(data + 1, size - 1);
  try {
    const MeshFile file = MeshFile::read({text.begin(), text.end()}, name);
    expect(file.vertex_count() <= text.size() || !file.why_fixed().empty());
    if (file.why_fixed().empty()) round_trip(file, name);
  } catch (const triglyph::Error&) {
    return 0;
  }
  return 0;
}
