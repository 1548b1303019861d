// Opening, patching and writing mesh files, beside OpenMesh doing the same work.
#include <OpenMesh/Core/IO/MeshIO.hh>

// OpenMesh wants its readers included before the mesh type.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <benchmark/benchmark.h>

#include "engine/io/export_mesh.h"
#include "engine/io/file_bytes.h"
#include "engine/io/mesh_file.h"
#include "engine/io/readers.h"

namespace {

using triglyph::ExportFormat;
using triglyph::FileFormat;
using triglyph::Mesh;
using triglyph::MeshFile;
using triglyph::Vec3;

const char* const kBunny = "/usr/share/glmark2/models/bunny.obj";  // Debian's glmark2-data

Mesh make_waves(std::uint32_t side) {
  Mesh mesh;
  for (std::uint32_t i = 0; i < side * side; ++i) {
    const double x = (i % side) * 0.0123456, y = (i / side) * 0.0123456;
    mesh.positions.emplace_back(x, y, std::sin(3 * x) * std::cos(2 * y));
  }
  for (std::uint32_t i = 0; i + side + 1 < side * side; ++i) {
    if (i % side + 1 == side) continue;
    mesh.triangles.push_back({i, i + 1, i + side});
    mesh.triangles.push_back({i + 1, i + side + 1, i + side});
  }
  return mesh;
}

std::filesystem::path scratch(const std::string& name) {
  return std::filesystem::temp_directory_path() / ("triglyph-bench-" + name);
}

void write(const std::filesystem::path& path, const std::vector<char>& bytes) {
  std::ofstream file(path, std::ios::binary);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

// A file of about 40 MB, made once.
const std::filesystem::path& large_obj() {
  static const std::filesystem::path path = [] {
    auto made = scratch("waves.obj");
    write(made, triglyph::export_mesh(make_waves(750), {FileFormat::Obj, false, 6}));
    return made;
  }();
  return path;
}

void count_bytes(benchmark::State& state, std::size_t bytes) {
  state.SetBytesProcessed(static_cast<std::int64_t>(bytes) * state.iterations());
}

// The reader alone, on one thread.
void BM_ScanObj(benchmark::State& state) {
  const auto mapped = triglyph::FileBytes::open(large_obj());
  for (auto _ : state) {
    benchmark::DoNotOptimize(triglyph::read_obj({mapped.bytes(), large_obj()}));
  }
  count_bytes(state, mapped.bytes().size());
}
BENCHMARK(BM_ScanObj)->UseRealTime()->Unit(benchmark::kMillisecond);

void BM_OpenObj(benchmark::State& state) {
  std::size_t bytes = 0;
  for (auto _ : state) bytes = MeshFile::open(large_obj()).bytes().size();
  count_bytes(state, bytes);
}
BENCHMARK(BM_OpenObj)->UseRealTime()->Unit(benchmark::kMillisecond);

// A GLB of 20 MB, with positions and indices alone: nothing in it is passed over.
const std::filesystem::path& large_glb() {
  static const std::filesystem::path path = [] {
    auto made = scratch("waves.glb");
    write(made, triglyph::export_mesh(make_waves(750), {FileFormat::Glb}));
    return made;
  }();
  return path;
}

void BM_OpenGlb(benchmark::State& state) {
  std::size_t bytes = 0;
  for (auto _ : state) bytes = MeshFile::open(large_glb()).bytes().size();
  count_bytes(state, bytes);
}
BENCHMARK(BM_OpenGlb)->UseRealTime()->Unit(benchmark::kMillisecond);

void BM_PatchGlb(benchmark::State& state) {
  const MeshFile file = MeshFile::open(large_glb());
  std::vector<Vec3> positions = file.mesh().positions;
  for (Vec3& p : positions) p *= 1.001;
  for (auto _ : state) benchmark::DoNotOptimize(file.patched(positions));
  count_bytes(state, file.bytes().size());
}
BENCHMARK(BM_PatchGlb)->UseRealTime()->Unit(benchmark::kMillisecond);

void BM_PatchObj(benchmark::State& state) {
  const MeshFile file = MeshFile::open(large_obj());
  std::vector<Vec3> positions = file.mesh().positions;
  for (Vec3& p : positions) p = file.round(p * 1.001 + Vec3(0.01, 0.02, 0.03));
  for (auto _ : state) benchmark::DoNotOptimize(file.patched(positions));
  count_bytes(state, file.bytes().size());
}
BENCHMARK(BM_PatchObj)->UseRealTime()->Unit(benchmark::kMillisecond);

void BM_ExportObj(benchmark::State& state) {
  const Mesh mesh = make_waves(750);
  for (auto _ : state) benchmark::DoNotOptimize(triglyph::export_mesh(mesh, {FileFormat::Obj}));
  state.SetItemsProcessed(static_cast<std::int64_t>(mesh.triangles.size()) * state.iterations());
}
BENCHMARK(BM_ExportObj)->UseRealTime()->Unit(benchmark::kMillisecond);

bool has_bunny(benchmark::State& state) {
  const bool has = std::filesystem::exists(kBunny);
  if (!has) state.SkipWithError("needs Debian's glmark2-data");
  return has;
}

void BM_OpenBunny(benchmark::State& state) {
  if (!has_bunny(state)) return;
  for (auto _ : state) benchmark::DoNotOptimize(MeshFile::open(kBunny).face_count());
}
BENCHMARK(BM_OpenBunny)->UseRealTime()->Unit(benchmark::kMillisecond);

// Every vertex moves.
void BM_RewriteBunny(benchmark::State& state) {
  if (!has_bunny(state)) return;
  for (auto _ : state) {
    const MeshFile file = MeshFile::open(kBunny);
    std::vector<Vec3> positions = file.mesh().positions;
    for (Vec3& p : positions) p += Vec3(0.001, 0.001, 0.001);
    write(scratch("ours.obj"), file.patched(positions));
  }
}
BENCHMARK(BM_RewriteBunny)->UseRealTime()->Unit(benchmark::kMillisecond);

void BM_RewriteBunnyOpenMesh(benchmark::State& state) {
  if (!has_bunny(state)) return;
  for (auto _ : state) {
    OpenMesh::TriMesh_ArrayKernelT<> mesh;
    if (!OpenMesh::IO::read_mesh(mesh, kBunny)) state.SkipWithError("OpenMesh cannot read");
    for (const auto v : mesh.vertices()) {
      mesh.point(v) += OpenMesh::Vec3f(0.001F, 0.001F, 0.001F);
    }
    if (!OpenMesh::IO::write_mesh(mesh, scratch("openmesh.obj").string())) {
      state.SkipWithError("OpenMesh cannot write");
    }
  }
}
BENCHMARK(BM_RewriteBunnyOpenMesh)->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace
