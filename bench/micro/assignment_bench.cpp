#include <algorithm>

#include <benchmark/benchmark.h>

#include "engine/assignment/assignment.h"
#include "engine/base/parallel.h"
#include "engine/base/random.h"

namespace triglyph {
namespace {

enum class Kind { Uniform, Separable };

// Separable: max(a_i, S_i(s_j), D_i(d_j)), a_i heavy-tailed, as the schemes produce.
CostMatrix make_costs(Kind kind, std::uint32_t units, std::uint32_t words) {
  CostMatrix costs{units, words, std::vector<float>(static_cast<std::size_t>(units) * words)};
  parallel_for(words, [&](std::size_t word) {
    for (std::uint32_t unit = 0; unit < units; ++unit) {
      const std::uint64_t pair = static_cast<std::uint64_t>(unit) << 32;
      double cost = random_unit(1, 1, pair | word);
      if (kind == Kind::Separable) {
        const double alone = 0.05 / (0.001 + random_unit(1, 2, unit));
        const double split = random_unit(1, 3, pair | (word % 256));
        const double data = random_unit(1, 4, pair | (word * 2654435761U >> 7) % 64);
        cost = std::max({alone, split, data});
      }
      costs.values[word * units + unit] = static_cast<float>(cost);
    }
  });
  return costs;
}

using Solver = Assignment (*)(const CostMatrix&, std::span<const std::uint32_t>);

void run(benchmark::State& state, Solver solve, Kind kind, std::uint32_t units,
         const std::vector<std::uint32_t>& demand) {
  const CostMatrix costs = make_costs(kind, units, static_cast<std::uint32_t>(demand.size()));
  Assignment result;
  for (auto _ : state) result = solve(costs, demand);
  state.counters["max"] = result.max_cost;
  state.counters["sum"] = result.sum_cost;
  state.SetItemsProcessed(state.iterations() * units);
}

// As many words as units, each once.
void run_distinct(benchmark::State& state, Solver solve, Kind kind) {
  const auto units = static_cast<std::uint32_t>(state.range(0));
  run(state, solve, kind, units, std::vector<std::uint32_t>(units, 1));
}

// Every unit is used; words are repeated evenly.
void run_repeated(benchmark::State& state, Solver solve, Kind kind) {
  const auto units = static_cast<std::uint32_t>(state.range(0));
  const auto words = static_cast<std::uint32_t>(state.range(1));
  std::vector<std::uint32_t> demand(words, units / words);
  for (std::uint32_t word = 0; word < units % words; ++word) ++demand[word];
  run(state, solve, kind, units, demand);
}

// 32 copies of each word, the other units stay unused.
void run_chosen(benchmark::State& state, Solver solve, Kind kind) {
  const auto units = static_cast<std::uint32_t>(state.range(0));
  const auto words = static_cast<std::uint32_t>(state.range(1));
  run(state, solve, kind, units, std::vector<std::uint32_t>(words, 32));
}

void BM_SolveBottleneck(benchmark::State& s) {
  run_distinct(s, assign_bottleneck, Kind::Uniform);
}
void BM_SolveLeastSum(benchmark::State& s) {
  run_distinct(s, assign_least_sum, Kind::Uniform);
}
void BM_SolveBottleneckSeparable(benchmark::State& s) {
  run_distinct(s, assign_bottleneck, Kind::Separable);
}
void BM_SolveLeastSumSeparable(benchmark::State& s) {
  run_distinct(s, assign_least_sum, Kind::Separable);
}
void BM_SolveBottleneckRepeated(benchmark::State& s) {
  run_repeated(s, assign_bottleneck, Kind::Separable);
}
void BM_SolveLeastSumRepeated(benchmark::State& s) {
  run_repeated(s, assign_least_sum, Kind::Separable);
}
void BM_SolveLeastSumRepeatedUniform(benchmark::State& s) {
  run_repeated(s, assign_least_sum, Kind::Uniform);
}
void BM_SolveBottleneckRepeatedUniform(benchmark::State& s) {
  run_repeated(s, assign_bottleneck, Kind::Uniform);
}
void BM_SolveBottleneckChosen(benchmark::State& s) {
  run_chosen(s, assign_bottleneck, Kind::Separable);
}
void BM_SolveLeastSumChosen(benchmark::State& s) {
  run_chosen(s, assign_least_sum, Kind::Separable);
}

void distinct_sizes(benchmark::internal::Benchmark* bench) {
  bench->Arg(512)->Arg(1024)->Arg(2048)->Arg(4096)->Arg(5337);
  bench->Unit(benchmark::kMillisecond)->UseRealTime();
}
void repeated_sizes(benchmark::internal::Benchmark* bench) {
  bench->Args({5300, 9})->Args({100000, 256})->Unit(benchmark::kMillisecond)->UseRealTime();
}
void chosen_sizes(benchmark::internal::Benchmark* bench) {
  bench->Args({5300, 9})->Args({100000, 256})->Unit(benchmark::kMillisecond)->UseRealTime();
}

BENCHMARK(BM_SolveBottleneck)->Apply(distinct_sizes);
BENCHMARK(BM_SolveLeastSum)->Apply(distinct_sizes);
BENCHMARK(BM_SolveBottleneckSeparable)->Apply(distinct_sizes);
BENCHMARK(BM_SolveLeastSumSeparable)->Apply(distinct_sizes);
BENCHMARK(BM_SolveBottleneckRepeated)->Apply(repeated_sizes);
BENCHMARK(BM_SolveLeastSumRepeated)->Apply(repeated_sizes);
BENCHMARK(BM_SolveBottleneckRepeatedUniform)->Apply(repeated_sizes);
BENCHMARK(BM_SolveLeastSumRepeatedUniform)->Apply(repeated_sizes);
BENCHMARK(BM_SolveBottleneckChosen)->Apply(chosen_sizes);
BENCHMARK(BM_SolveLeastSumChosen)->Apply(chosen_sizes);

}  // namespace
}  // namespace triglyph
