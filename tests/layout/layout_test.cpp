#include "engine/layout/layout.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <set>

#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "engine/base/random.h"
#include "engine/scheme/tsq/tsq.h"
#include "tests/support/arenas.h"
#include "tests/support/shapes.h"

namespace triglyph {
namespace {

// Units that move 1 to 3 random points and read up to 2 more.
UnitSet random_units(std::uint64_t seed, std::uint32_t count, std::uint32_t points) {
  UnitSet units;
  const auto append = [](PointLists& lists, const std::set<std::uint32_t>& list) {
    lists.points.insert(lists.points.end(), list.begin(), list.end());
    lists.offsets.push_back(static_cast<std::uint32_t>(lists.points.size()));
  };
  for (std::uint32_t i = 0; i < count; ++i) {
    std::set<std::uint32_t> moved, read;
    const auto draw = [&](std::uint64_t k) {
      return static_cast<std::uint32_t>(random_bits(seed, i, k) % points);
    };
    for (std::uint64_t k = 0; k <= random_bits(seed, i, 100) % 3; ++k) moved.insert(draw(k));
    read = moved;
    for (std::uint64_t k = 0; k < random_bits(seed, i, 101) % 3; ++k) read.insert(draw(10 + k));
    units.anchors.push_back(i);
    append(units.moved, moved);
    append(units.read, read);
  }
  return units;
}

bool meets(std::span<const std::uint32_t> a, std::span<const std::uint32_t> b) {
  return std::any_of(a.begin(), a.end(), [&](std::uint32_t point) {
    return std::find(b.begin(), b.end(), point) != b.end();
  });
}

bool interfere(const UnitSet& units, std::size_t i, std::size_t j, ConflictRule rule) {
  if (rule == ConflictRule::SharedPoint) return meets(units.read[i], units.read[j]);
  return meets(units.moved[i], units.read[j]) || meets(units.moved[j], units.read[i]);
}

class BothRules : public testing::TestWithParam<ConflictRule> {};
INSTANTIATE_TEST_SUITE_P(All, BothRules,
                         testing::Values(ConflictRule::ReadWrite, ConflictRule::SharedPoint));

TEST_P(BothRules, NeighboursAreExactlyTheUnitsThatInterfere) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const UnitSet units = random_units(seed, 40, 30);
    const Conflicts conflicts(units.moved, units.read_or_moved(), 30, GetParam());
    for (std::uint32_t i = 0; i < units.size(); ++i) {
      std::set<std::uint32_t> neighbours;
      conflicts.for_each_neighbour(i, [&](std::uint32_t j) { neighbours.insert(j); });
      neighbours.erase(i);
      std::set<std::uint32_t> expected;
      for (std::uint32_t j = 0; j < units.size(); ++j) {
        if (j != i && interfere(units, i, j, GetParam())) expected.insert(j);
      }
      EXPECT_EQ(neighbours, expected);
    }
  }
}

TEST_P(BothRules, LayoutsAreMaximalIndependentAndWithinTheBound) {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    const UnitSet units = random_units(seed, 60, 50);
    const Conflicts conflicts(units.moved, units.read_or_moved(), 50, GetParam());
    for (const std::string_view name : layout_names()) {
      const auto chosen =
          choose_layout(conflicts, {.method = layout_method(std::string(name)), .iterations = 4});
      EXPECT_TRUE(std::is_sorted(chosen.begin(), chosen.end()));
      EXPECT_LE(chosen.size(), layout_bound(conflicts));
      for (std::uint32_t i = 0; i < units.size(); ++i) {
        const auto clashes = std::count_if(chosen.begin(), chosen.end(), [&](std::uint32_t j) {
          return i != j && interfere(units, i, j, GetParam());
        });
        const bool is_chosen = std::binary_search(chosen.begin(), chosen.end(), i);
        EXPECT_EQ(clashes == 0, is_chosen);
      }
    }
  }
}

std::size_t maximum_by_brute_force(const UnitSet& units, ConflictRule rule) {
  std::vector<std::uint32_t> blocked(units.size());
  for (std::size_t i = 0; i < units.size(); ++i) {
    for (std::size_t j = 0; j < units.size(); ++j) {
      if (i != j && interfere(units, i, j, rule)) blocked[i] |= 1U << j;
    }
  }
  std::size_t best = 0;
  for (std::uint32_t set = 0; set < 1U << units.size(); ++set) {
    bool independent = true;
    for (std::size_t i = 0; i < units.size() && independent; ++i) {
      independent = ((set >> i) & 1U) == 0 || (set & blocked[i]) == 0;
    }
    if (independent) best = std::max<std::size_t>(best, std::popcount(set));
  }
  return best;
}

TEST_P(BothRules, BoundHoldsAndMinDegreeIsNearlyMaximum) {
  std::size_t optimum = 0, greedy = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const UnitSet units = random_units(100 + seed, 14, 20);
    const Conflicts conflicts(units.moved, units.read_or_moved(), 20, GetParam());
    const std::size_t best = maximum_by_brute_force(units, GetParam());
    EXPECT_LE(best, layout_bound(conflicts));
    const std::size_t found = min_degree_layout(conflicts).size();
    EXPECT_LE(found, best);
    optimum += best;
    greedy += found;
  }
  EXPECT_GE(greedy * 100, optimum * 95);
}

TEST(FirstFit, TakesUnitsInOrder) {
  const UnitSet units = random_units(5, 50, 40);
  const Conflicts conflicts(units.moved, units.read_or_moved(), 40, ConflictRule::ReadWrite);
  std::vector<std::uint32_t> expected;
  for (std::uint32_t i = 0; i < units.size(); ++i) {
    if (std::none_of(expected.begin(), expected.end(), [&](std::uint32_t j) {
          return interfere(units, i, j, ConflictRule::ReadWrite);
        })) {
      expected.push_back(i);
    }
  }
  EXPECT_EQ(first_fit_layout(conflicts), expected);
}

TEST(MinDegree, FindsMoreUnitsOnASurface) {
  const WordCode code(Key::trial(), {});
  const UnitSet units = TsqScheme(code, {}).bind(test::bumpy_ball().surface())->find_units();
  const Conflicts conflicts(units.moved, units.read_or_moved(),
                            test::bumpy_ball().mesh.positions.size(), ConflictRule::ReadWrite);
  const std::size_t first_fit = first_fit_layout(conflicts).size();
  const std::size_t min_degree = min_degree_layout(conflicts).size();
  EXPECT_GT(min_degree * 100, first_fit * 104);
}

TEST_P(BothRules, LocalSearchFindsTheMaximumOfSmallGraphs) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const UnitSet units = random_units(300 + seed, 16, 20);
    const Conflicts conflicts(units.moved, units.read_or_moved(), 20, GetParam());
    EXPECT_EQ(local_search_layout(conflicts, {.iterations = 400}).size(),
              maximum_by_brute_force(units, GetParam()));
  }
}

struct SurfaceUnits {
  UnitSet units =
      TsqScheme(WordCode(Key::trial(), {}), {}).bind(test::bumpy_ball().surface())->find_units();
  Conflicts conflicts{units.moved, units.read_or_moved(), test::bumpy_ball().mesh.positions.size(),
                      ConflictRule::ReadWrite};
};

TEST(LocalSearch, FindsMoreUnitsOnASurfaceThanAnyOther) {
  const SurfaceUnits subject;
  const std::size_t found = local_search_layout(subject.conflicts, {.iterations = 64}).size();
  for (const std::string_view name : layout_names()) {
    const LayoutMethod method = layout_method(std::string(name));
    if (method == LayoutMethod::LocalSearch) continue;
    const auto other = choose_layout(subject.conflicts, {.method = method, .iterations = 16});
    EXPECT_GT(found * 100, other.size() * 103) << name;
  }
}

TEST(LocalSearch, StopsWhenItsTimeIsUp) {
  const SurfaceUnits subject;
  const auto start = std::chrono::steady_clock::now();
  const auto found = local_search_layout(subject.conflicts, {.seconds = 0.2});
  EXPECT_GE(found.size(), min_degree_layout(subject.conflicts).size());
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));
}

TEST(AntColony, LearnsFromItsAnts) {
  const SurfaceUnits subject;
  EXPECT_GT(ant_colony_layout(subject.conflicts, {.iterations = 400}).size(),
            random_degree_layout(subject.conflicts, {.iterations = 400}).size());
}

TEST(StaticDegree, TakesUnitsByTheirDegree) {
  // a star: the centre moves the points that the leaves move, one each
  UnitSet units;
  units.anchors = {0, 1, 2, 3};
  units.moved = {{0, 3, 4, 5, 6}, {0, 1, 2, 0, 1, 2}};
  const Conflicts conflicts(units.moved, units.read_or_moved(), 3, ConflictRule::ReadWrite);
  EXPECT_EQ(static_degree_layout(conflicts), (std::vector<std::uint32_t>{1, 2, 3}));
  EXPECT_EQ(first_fit_layout(conflicts), (std::vector<std::uint32_t>{0}));
}

TEST(Layout, IsTheSameForAnyNumberOfThreads) {
  const SurfaceUnits subject;
  for (const std::string_view name : layout_names()) {
    const LayoutOptions options{.method = layout_method(std::string(name)), .iterations = 9};
    test::expect_same_for_any_threads([&] { return choose_layout(subject.conflicts, options); });
  }
}

TEST(Layout, OfNothingIsEmpty) {
  const UnitSet units;
  const Conflicts conflicts(units.moved, units.read_or_moved(), 0, ConflictRule::ReadWrite);
  for (const std::string_view name : layout_names()) {
    EXPECT_TRUE(choose_layout(conflicts, {.method = layout_method(std::string(name))}).empty());
  }
  EXPECT_EQ(layout_bound(conflicts), 0U);
}

TEST(Layout, NamesRoundTrip) {
  EXPECT_EQ(layout_method("first-fit"), LayoutMethod::FirstFit);
  EXPECT_EQ(layout_method("local-search"), LayoutMethod::LocalSearch);
  for (const std::string_view name : layout_names()) {
    EXPECT_EQ(name_of(layout_method(std::string(name))), name);
  }
  EXPECT_THROW((void)layout_method("best"), Error);
}

}  // namespace
}  // namespace triglyph
