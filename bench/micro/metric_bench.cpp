// Distances between meshes, beside CGAL's of the same certainty.
#include <benchmark/benchmark.h>

#include "engine/geometry/box.h"
#include "engine/io/mesh_file.h"
#include "engine/marking/mark.h"
#include "engine/mesh/halfedges.h"
#include "engine/metric/comparison.h"
#include "engine/samples/sample_shapes.h"
#include "engine/scheme/registry.h"
#include "tests/support/cgal_hausdorff.h"
#include "tests/support/remeshing.h"

namespace triglyph {
namespace {

Mesh marked(const Mesh& mesh, const std::string& scheme) {
  const Halfedges halfedges = build_halfedges(mesh);
  const SchemeDefaults defaults = scheme_info(scheme).defaults(false, Strength::Normal);
  MarkOptions options;
  options.scheme = scheme;
  options.format = defaults.format;
  options.scheme_options = defaults.options;
  return {mark(
              {mesh, halfedges}, Message{1, 2, 3, 4, 5, 6, 7, 8}, Key::trial(), options,
              [](const Vec3& point) { return point; }, 0)
              .positions,
          mesh.triangles};
}

const Mesh& bunny() {
  static const Mesh mesh = MeshFile::open("/usr/share/glmark2/models/bunny.obj").mesh();
  return mesh;
}
const Mesh& marked_bunny() {
  static const Mesh mesh = marked(bunny(), "tsq");
  return mesh;
}
const Mesh& decimated_bunny() {
  static const Mesh mesh = test::decimated(bunny(), 0.5);
  return mesh;
}

double tolerance_of(const Mesh& mesh) {
  return kHausdorffTolerance * box_diagonal(mesh.positions);
}

void BM_HausdorffOfMove(benchmark::State& state) {
  const Mesh mesh =
      make_sample_shape(SampleShape::Closed, static_cast<std::size_t>(state.range(0)), 7);
  const Mesh moved = marked(mesh, "tsq");
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        hausdorff_of_move(mesh.triangles, mesh.positions, moved.positions, tolerance_of(mesh)));
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(mesh.triangles.size()));
}

void BM_MarkedBunny(benchmark::State& state) {
  const Mesh& mesh = bunny();
  for (auto _ : state) {
    benchmark::DoNotOptimize(hausdorff_of_move(mesh.triangles, mesh.positions,
                                               marked_bunny().positions, tolerance_of(mesh)));
  }
}
void BM_MarkedBunnyAsAny(benchmark::State& state) {
  for (auto _ : state) {
    benchmark::DoNotOptimize(hausdorff(bunny(), marked_bunny(), tolerance_of(bunny())));
  }
}
void BM_MarkedBunnyCgal(benchmark::State& state) {
  for (auto _ : state) {
    benchmark::DoNotOptimize(test::cgal_hausdorff(bunny(), marked_bunny(), tolerance_of(bunny())));
  }
}
void BM_DecimatedBunny(benchmark::State& state) {
  for (auto _ : state) {
    benchmark::DoNotOptimize(hausdorff(bunny(), decimated_bunny(), tolerance_of(bunny())));
  }
}
void BM_DecimatedBunnyCgal(benchmark::State& state) {
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        test::cgal_hausdorff(bunny(), decimated_bunny(), tolerance_of(bunny())));
  }
}

// Every metric by name, on the bunny and its marked copy.
void BM_Metric(benchmark::State& state) {
  const std::string_view name = metric_names()[static_cast<std::size_t>(state.range(0))];
  for (auto _ : state) benchmark::DoNotOptimize(compare(bunny(), marked_bunny(), name));
  state.SetLabel(std::string(name));
}

BENCHMARK(BM_Metric)->DenseRange(0, 9)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(BM_HausdorffOfMove)
    ->Arg(10000)
    ->Arg(100000)
    ->Arg(1000000)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK(BM_MarkedBunny)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(BM_MarkedBunnyAsAny)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(BM_MarkedBunnyCgal)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(BM_DecimatedBunny)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(BM_DecimatedBunnyCgal)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace triglyph
