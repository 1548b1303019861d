#include "engine/layout/layout.h"

#include <algorithm>
#include <bit>
#include <set>

#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "engine/base/random.h"
#include "engine/scheme/tsq.h"
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
    const Conflicts conflicts(units, 30, GetParam());
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
    const Conflicts conflicts(units, 50, GetParam());
    for (const LayoutMethod method : {LayoutMethod::FirstFit, LayoutMethod::MinDegree}) {
      const auto chosen = choose_layout(conflicts, method);
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
    const Conflicts conflicts(units, 20, GetParam());
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
  const Conflicts conflicts(units, 40, ConflictRule::ReadWrite);
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
  const UnitSet units = TsqScheme(code, {}).find_units(test::bumpy_ball().surface());
  const Conflicts conflicts(units, test::bumpy_ball().mesh.positions.size(),
                            ConflictRule::ReadWrite);
  const std::size_t first_fit = first_fit_layout(conflicts).size();
  const std::size_t min_degree = min_degree_layout(conflicts).size();
  EXPECT_GT(min_degree * 100, first_fit * 104);
}

TEST(Layout, OfNothingIsEmpty) {
  const UnitSet units;
  const Conflicts conflicts(units, 0, ConflictRule::ReadWrite);
  EXPECT_TRUE(first_fit_layout(conflicts).empty());
  EXPECT_TRUE(min_degree_layout(conflicts).empty());
  EXPECT_EQ(layout_bound(conflicts), 0U);
}

TEST(Layout, NamesRoundTrip) {
  EXPECT_EQ(layout_method("first-fit"), LayoutMethod::FirstFit);
  EXPECT_EQ(layout_method(std::string(name_of(LayoutMethod::MinDegree))), LayoutMethod::MinDegree);
  EXPECT_THROW((void)layout_method("best"), Error);
}

}  // namespace
}  // namespace triglyph
