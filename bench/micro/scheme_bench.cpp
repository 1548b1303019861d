// The stages of marking one mesh: sample shapes of growing size, so that the growth can be read
// off.
#include <benchmark/benchmark.h>

#include "engine/io/mesh_file.h"
#include "engine/layout/layout.h"
#include "engine/marking/mark.h"
#include "engine/mesh/edge_length.h"
#include "engine/mesh/halfedges.h"
#include "engine/samples/sample_shapes.h"
#include "engine/scheme/iie/integral_invariants.h"
#include "engine/scheme/registry.h"

namespace triglyph {
namespace {

struct Subject {
  Mesh mesh;
  Halfedges halfedges;
  MarkOptions options;
  std::unique_ptr<Scheme> scheme;
  std::unique_ptr<BoundScheme> bound;
  UnitSet units;

  explicit Subject(std::size_t triangles, const std::string& name = "tsq")
      : mesh(make_sample_shape(SampleShape::Closed, triangles, 1)),
        halfedges(build_halfedges(mesh)),
        options(default_mark_options(name, false)),
        scheme(make_scheme(name, WordCode(Key::trial(), options.format), options.scheme_options)),
        bound(scheme->bind(surface())),
        units(bound->find_units()) {}
  [[nodiscard]] Surface surface() const { return {mesh, halfedges}; }
};

void count_triangles(benchmark::State& state, const Mesh& mesh) {
  state.counters["triangles/s"] = benchmark::Counter(static_cast<double>(mesh.triangles.size()),
                                                     benchmark::Counter::kIsIterationInvariantRate);
}

void BM_Halfedges(benchmark::State& state) {
  const Subject subject(static_cast<std::size_t>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(build_halfedges(subject.mesh));
  count_triangles(state, subject.mesh);
}

void BM_FindUnits(benchmark::State& state, const std::string& scheme) {
  const Subject subject(static_cast<std::size_t>(state.range(0)), scheme);
  for (auto _ : state)
    benchmark::DoNotOptimize(subject.scheme->bind(subject.surface())->find_units());
  count_triangles(state, subject.mesh);
}

void BM_Layout(benchmark::State& state, LayoutMethod method) {
  const Subject subject(static_cast<std::size_t>(state.range(0)));
  std::size_t units = 0;
  for (auto _ : state) {
    const Conflicts conflicts(subject.units.moved, subject.units.read_or_moved(),
                              subject.mesh.positions.size(), ConflictRule::ReadWrite);
    units = choose_layout(conflicts, {.method = method}).size();
  }
  count_triangles(state, subject.mesh);
  state.counters["units"] = static_cast<double>(units);
}

void BM_Read(benchmark::State& state, const std::string& scheme) {
  const Subject subject(static_cast<std::size_t>(state.range(0)), scheme);
  for (auto _ : state) benchmark::DoNotOptimize(subject.scheme->bind(subject.surface())->read());
  count_triangles(state, subject.mesh);
}

// Area and volume invariants about every vertex of the bunny, balls of 4 mean edges.
void BM_InvariantsOfBunny(benchmark::State& state) {
  const std::filesystem::path bunny = "/usr/share/glmark2/models/bunny.obj";
  if (!std::filesystem::exists(bunny)) {
    state.SkipWithError("glmark2-data is not installed");
    return;
  }
  const Mesh mesh = MeshFile::open(bunny).mesh();
  const std::vector<char> unfit(mesh.triangles.size(), 0);
  const double radius = 4 * mean_edge_length(mesh);
  for (auto _ : state) {
    const SpatialIndex index(mesh.positions, mesh.triangles);
    benchmark::DoNotOptimize(all_ball_invariants(mesh.positions, mesh.triangles, index, unfit,
                                                 mesh.positions, radius, mesh.triangles.size()));
  }
  state.counters["balls/s"] = benchmark::Counter(static_cast<double>(mesh.positions.size()),
                                                 benchmark::Counter::kIsIterationInvariantRate);
}

void BM_MarkMessage(benchmark::State& state, const std::string& scheme) {
  const Subject subject(static_cast<std::size_t>(state.range(0)), scheme);
  const Message message{1, 2, 3, 4, 5, 6, 7, 8};
  for (auto _ : state) {
    benchmark::DoNotOptimize(mark(
        subject.surface(), message, Key::trial(), subject.options,
        [](const Vec3& point) { return point; }, 0));
  }
  count_triangles(state, subject.mesh);
}

void sizes(benchmark::internal::Benchmark* bench) {
  bench->Arg(10000)->Arg(100000)->Arg(1000000)->Unit(benchmark::kMillisecond)->UseRealTime();
}

// for solvers that pass over the candidates many times
void small_sizes(benchmark::internal::Benchmark* bench) {
  bench->Arg(10000)->Arg(100000)->Unit(benchmark::kMillisecond)->UseRealTime();
}

BENCHMARK(BM_Halfedges)->Apply(sizes);
BENCHMARK_CAPTURE(BM_FindUnits, tsq, "tsq")->Apply(sizes);
BENCHMARK_CAPTURE(BM_FindUnits, aie, "aie")->Apply(sizes);
BENCHMARK_CAPTURE(BM_FindUnits, iie, "iie")->Apply(small_sizes);
BENCHMARK_CAPTURE(BM_Layout, first_fit, LayoutMethod::FirstFit)->Apply(sizes);
BENCHMARK_CAPTURE(BM_Layout, min_degree, LayoutMethod::MinDegree)->Apply(sizes);
BENCHMARK_CAPTURE(BM_Layout, static_degree, LayoutMethod::StaticDegree)->Apply(sizes);
BENCHMARK_CAPTURE(BM_Layout, random_degree, LayoutMethod::RandomDegree)->Apply(small_sizes);
BENCHMARK_CAPTURE(BM_Layout, ant_colony, LayoutMethod::AntColony)->Apply(small_sizes);
BENCHMARK_CAPTURE(BM_Layout, local_search, LayoutMethod::LocalSearch)->Apply(sizes);
BENCHMARK_CAPTURE(BM_Read, tsq, "tsq")->Apply(sizes);
BENCHMARK_CAPTURE(BM_Read, aie, "aie")->Apply(sizes);
BENCHMARK_CAPTURE(BM_Read, iie, "iie")->Apply(small_sizes);
BENCHMARK_CAPTURE(BM_MarkMessage, tsq, "tsq")->Apply(sizes);
BENCHMARK_CAPTURE(BM_MarkMessage, aie, "aie")->Apply(sizes);
BENCHMARK_CAPTURE(BM_MarkMessage, iie, "iie")->Apply(small_sizes);
BENCHMARK(BM_InvariantsOfBunny)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace triglyph
