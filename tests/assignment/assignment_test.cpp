#include "engine/assignment/assignment.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include "tests/assignment/random_costs.h"

namespace triglyph {
namespace {

using Solver = Assignment (*)(const CostMatrix&, std::span<const std::uint32_t>);

struct Best {
  std::uint32_t matched = 0;
  double max_cost = 0;
  double sum_cost = 0;
};

// Tries every assignment.
class BruteForce {
 public:
  BruteForce(const CostMatrix& costs, std::vector<std::uint32_t> demand, bool by_maximum)
      : costs_(costs), left_(std::move(demand)), by_maximum_(by_maximum) {
    try_unit(0, {});
  }
  [[nodiscard]] Best best() const { return best_; }

 private:
  void try_unit(std::uint32_t unit, Best sofar) {
    if (unit == costs_.units) {
      if (is_better(sofar)) best_ = sofar;
      return;
    }
    if (sofar.matched + costs_.units - unit < best_.matched) return;
    for (std::uint32_t word = 0; word < costs_.words; ++word) {
      const double cost = costs_.at(unit, word);
      if (left_[word] == 0 || cost == kImpossible) continue;
      --left_[word];
      try_unit(unit + 1,
               {sofar.matched + 1, std::max(sofar.max_cost, cost), sofar.sum_cost + cost});
      ++left_[word];
    }
    try_unit(unit + 1, sofar);
  }

  [[nodiscard]] bool is_better(const Best& other) const {
    if (other.matched != best_.matched) return other.matched > best_.matched;
    if (by_maximum_ && other.max_cost != best_.max_cost) return other.max_cost < best_.max_cost;
    return other.sum_cost < best_.sum_cost;
  }

  const CostMatrix& costs_;
  std::vector<std::uint32_t> left_;
  bool by_maximum_;
  Best best_;
};

void expect_valid(const CostMatrix& costs, std::span<const std::uint32_t> demand,
                  const Assignment& assignment) {
  ASSERT_EQ(assignment.word_of_unit.size(), costs.units);
  std::vector<std::uint32_t> used(costs.words, 0);
  Best seen;
  for (std::uint32_t unit = 0; unit < costs.units; ++unit) {
    const std::uint32_t word = assignment.word_of_unit[unit];
    if (word == kNoWord) continue;
    ASSERT_LT(word, costs.words);
    ASSERT_NE(costs.at(unit, word), kImpossible);
    ++used[word];
    ++seen.matched;
    seen.max_cost = std::max<double>(seen.max_cost, costs.at(unit, word));
    seen.sum_cost += costs.at(unit, word);
  }
  for (std::uint32_t word = 0; word < costs.words; ++word) EXPECT_LE(used[word], demand[word]);
  EXPECT_EQ(assignment.matched, seen.matched);
  EXPECT_EQ(assignment.max_cost, seen.max_cost);
  EXPECT_EQ(assignment.sum_cost, seen.sum_cost);
}

void expect_best(const CostMatrix& costs, const std::vector<std::uint32_t>& demand) {
  for (const bool by_maximum : {true, false}) {
    const Best best = BruteForce(costs, demand, by_maximum).best();
    const Assignment found =
        by_maximum ? assign_bottleneck(costs, demand) : assign_least_sum(costs, demand);
    expect_valid(costs, demand, found);
    EXPECT_EQ(found.matched, best.matched);
    EXPECT_NEAR(found.sum_cost, best.sum_cost, 1e-12 * best.sum_cost);
    if (by_maximum) {
      EXPECT_EQ(found.max_cost, best.max_cost);
    }
  }
}

TEST(Assignment, AgreesWithBruteForceOnSmallInstances) {
  for (std::uint64_t seed = 0; seed < 1500; ++seed) {
    const CostKind kind = kCostKinds[seed % std::size(kCostKinds)];
    const auto units = static_cast<std::uint32_t>(random_bits(seed, 10, 0) % 7);
    const auto words = static_cast<std::uint32_t>(random_bits(seed, 10, 1) % 5);
    const auto total = static_cast<std::uint32_t>(random_bits(seed, 10, 2) % (units + 4));
    SCOPED_TRACE(seed);
    expect_best(make_costs(kind, units, words, seed), make_demand(words, total, seed));
    if (HasFailure()) return;
  }
}

TEST(Assignment, AgreesWithBruteForceOnSevenDistinctWords) {
  for (std::uint64_t seed = 0; seed < 70; ++seed) {
    const CostKind kind = kCostKinds[seed % std::size(kCostKinds)];
    SCOPED_TRACE(seed);
    expect_best(make_costs(kind, 7, 7, seed), std::vector<std::uint32_t>(7, 1));
    if (HasFailure()) return;
  }
}

TEST(Assignment, AgreesWithBruteForceWhenSizesDiffer) {
  for (std::uint64_t seed = 0; seed < 140; ++seed) {
    const CostKind kind = kCostKinds[seed % std::size(kCostKinds)];
    SCOPED_TRACE(seed);
    expect_best(make_costs(kind, 7, 3, seed), {1, 2, 1});
    expect_best(make_costs(kind, 4, 6, seed), {1, 1, 2, 1, 1, 3});
    expect_best(make_costs(kind, 6, 1, seed), {static_cast<std::uint32_t>(seed % 9)});
    expect_best(make_costs(kind, 1, 6, seed), {0, 1, 1, 0, 1, 4000000000U});
    if (HasFailure()) return;
  }
}

TEST(Assignment, IsEmptyWithoutUnitsOrWordsOrDemand) {
  for (const Solver solve : {assign_sequential, assign_bottleneck, assign_least_sum}) {
    EXPECT_EQ(solve({}, {}), Assignment{});
    const std::vector<std::uint32_t> three{1, 2, 3};
    EXPECT_EQ(solve({0, 3, {}}, three), Assignment{});
    EXPECT_EQ(solve({2, 0, {}}, {}).word_of_unit, std::vector<std::uint32_t>(2, kNoWord));
    const CostMatrix costs = make_costs(CostKind::Integers, 5, 3, 1);
    EXPECT_EQ(solve(costs, std::vector<std::uint32_t>(3, 0)).matched, 0U);
    const CostMatrix impossible{2, 2, std::vector<float>(4, kImpossible)};
    EXPECT_EQ(solve(impossible, std::vector<std::uint32_t>(2, 1)).matched, 0U);
  }
}

TEST(Assignment, RefusesBrokenInput) {
  const std::vector<std::uint32_t> one{1};
  for (const Solver solve : {assign_bottleneck, assign_least_sum}) {
    EXPECT_THROW((void)solve({2, 1, {1, -1}}, one), std::logic_error);
    EXPECT_THROW((void)solve({1, 1, {std::numeric_limits<float>::quiet_NaN()}}, one),
                 std::logic_error);
    EXPECT_THROW((void)solve({2, 1, {1}}, one), std::logic_error);
    EXPECT_THROW((void)solve({2, 2, {1, 1, 1, 1}}, one), std::logic_error);
  }
}

TEST(AssignSequential, DealsWordsInRoundsAndLosesImpossiblePairs) {
  CostMatrix costs = make_costs(CostKind::Integers, 8, 3, 4);
  EXPECT_EQ(assign_sequential(costs, std::vector<std::uint32_t>{1, 3, 2}).word_of_unit,
            (std::vector<std::uint32_t>{0, 1, 2, 1, 2, 1, kNoWord, kNoWord}));
  costs.values[1 * 8 + 3] = kImpossible;
  const std::vector<std::uint32_t> demand{5, 5, 5};
  const Assignment dealt = assign_sequential(costs, demand);
  EXPECT_EQ(dealt.word_of_unit, (std::vector<std::uint32_t>{0, 1, 2, 0, 1, 2, 0, 1}));
  costs.values[0 * 8 + 3] = kImpossible;
  const Assignment lossy = assign_sequential(costs, demand);
  EXPECT_EQ(lossy.word_of_unit, (std::vector<std::uint32_t>{0, 1, 2, kNoWord, 1, 2, 0, 1}));
  expect_valid(costs, demand, lossy);
}

// Row i of the result is row order[i] of the input, likewise for words.
CostMatrix permuted(const CostMatrix& costs, std::span<const std::uint32_t> unit_order,
                    std::span<const std::uint32_t> word_order) {
  CostMatrix result{costs.units, costs.words, {}};
  for (const std::uint32_t word : word_order) {
    for (const std::uint32_t unit : unit_order) result.values.push_back(costs.at(unit, word));
  }
  return result;
}

std::vector<std::uint32_t> shuffled(std::uint32_t count, std::uint64_t seed) {
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return random_bits(seed, 20, a) < random_bits(seed, 20, b);
  });
  return order;
}

TEST(Assignment, DoesNotDependOnTheOrderOfUnitsAndWords) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const CostKind kind = kCostKinds[seed % std::size(kCostKinds)];
    const std::uint32_t words = seed % 2 == 0 ? 60 : 7;
    const CostMatrix costs = make_costs(kind, 60, words, seed);
    const auto demand = make_demand(words, seed % 3 == 0 ? 40 : 60, seed);
    const auto unit_order = shuffled(60, seed);
    const auto word_order = shuffled(words, seed + 1);
    std::vector<std::uint32_t> other_demand;
    for (const std::uint32_t word : word_order) other_demand.push_back(demand[word]);
    const CostMatrix other = permuted(costs, unit_order, word_order);
    for (const Solver solve : {assign_bottleneck, assign_least_sum}) {
      const Assignment a = solve(costs, demand);
      const Assignment b = solve(other, other_demand);
      EXPECT_EQ(a.matched, b.matched);
      EXPECT_NEAR(a.sum_cost, b.sum_cost, 1e-12 * a.sum_cost);
      if (solve == assign_bottleneck) {
        EXPECT_EQ(a.max_cost, b.max_cost);
      }
      if (kind != CostKind::Real) continue;
      // Distinct real costs have one optimum.
      for (std::uint32_t unit = 0; unit < 60; ++unit) {
        const std::uint32_t word = b.word_of_unit[unit];
        EXPECT_EQ(a.word_of_unit[unit_order[unit]], word == kNoWord ? kNoWord : word_order[word]);
      }
    }
  }
}

TEST(Assignment, IsTheSameForAnyNumberOfThreads) {
  struct Size {
    std::uint32_t units, words, total;
  };
  for (const Size size : {Size{700, 700, 700}, Size{5000, 9, 288}, Size{3000, 40, 3000}}) {
    for (const CostKind kind : {CostKind::Real, CostKind::Separable, CostKind::MostlyImpossible}) {
      const CostMatrix costs = make_costs(kind, size.units, size.words, 3);
      std::vector<std::uint32_t> demand(size.words, size.total / size.words);
      for (const Solver solve : {assign_bottleneck, assign_least_sum}) {
        const Assignment expected =
            tbb::task_arena(1).execute([&] { return solve(costs, demand); });
        for (const int threads : {2, 3, 8}) {
          tbb::task_arena arena(threads);
          EXPECT_EQ(arena.execute([&] { return solve(costs, demand); }), expected) << threads;
        }
      }
    }
  }
}

}  // namespace
}  // namespace triglyph
