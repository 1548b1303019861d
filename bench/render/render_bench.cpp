// How long pictures take: a megapixel of the bunny at 16 samples is to stay within a second.
#include <benchmark/benchmark.h>

#include "engine/io/mesh_file.h"
#include "engine/samples/sample_shapes.h"
#include "render/comparison.h"
#include "render/ray_caster.h"

namespace triglyph {
namespace {

const Mesh& bunny() {
  static const Mesh mesh = MeshFile::open("/usr/share/glmark2/models/bunny.obj").mesh();
  return mesh;
}

// Normals, Embree's tree and the rays.
void BM_MegapixelOfBunny(benchmark::State& state) {
  const Camera camera = whole_view(bunny().positions, automatic_view(bunny()), 1);
  for (auto _ : state) {
    const Scene scene(bunny(), false);
    benchmark::DoNotOptimize(
        RayCaster(scene).draw(camera, 1000, 1000, static_cast<int>(state.range(0))));
  }
}

void BM_Comparison(benchmark::State& state) {
  const Mesh mesh =
      make_sample_shape(SampleShape::Closed, static_cast<std::size_t>(state.range(0)), 7);
  Mesh moved = mesh;
  moved.positions[0] += Vec3(0, 0, 1e-3);
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        draw_comparison(mesh, moved, {"original", "facets", "distance", "worst"}, {}));
  }
}

BENCHMARK(BM_MegapixelOfBunny)
    ->Arg(1)
    ->Arg(16)
    ->Arg(64)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK(BM_Comparison)
    ->Arg(10000)
    ->Arg(100000)
    ->Arg(1000000)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
}  // namespace triglyph
