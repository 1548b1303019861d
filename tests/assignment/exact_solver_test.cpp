// The solvers against LEMON's network simplex: a maximum-cardinality assignment is a flow whose
// pairs earn a reward that no sum of costs can outweigh, in 64-bit integers.
#include <cstdint>
#include <set>

#include <gtest/gtest.h>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wdeprecated-copy"
#pragma GCC diagnostic ignored "-Wpedantic"
#include <lemon/network_simplex.h>
#include <lemon/smart_graph.h>
#pragma GCC diagnostic pop

#include "engine/assignment/assignment.h"
#include "tests/assignment/random_costs.h"

namespace triglyph {
namespace {

struct Optimum {
  std::int64_t matched = 0;
  std::int64_t sum = 0;
};

constexpr std::int64_t kReward = 1LL << 40;  // more than 400 units of any cost below 2^31

// Costs must be integers.
Optimum solve_by_flow(const CostMatrix& costs, const std::vector<std::uint32_t>& demand,
                      double limit) {
  using Graph = lemon::SmartDigraph;
  Graph graph;
  const auto source = graph.addNode();
  const auto sink = graph.addNode();
  std::vector<Graph::Node> units;
  std::vector<std::int64_t> arc_cost;
  std::vector<std::int64_t> arc_room;
  const auto add_arc = [&](Graph::Node from, Graph::Node to, std::int64_t cost, std::int64_t room) {
    graph.addArc(from, to);
    arc_cost.push_back(cost);
    arc_room.push_back(room);
  };
  for (std::uint32_t unit = 0; unit < costs.units; ++unit) {
    units.push_back(graph.addNode());
    add_arc(units.back(), sink, 0, 1);
  }
  for (std::uint32_t word = 0; word < costs.words; ++word) {
    const auto node = graph.addNode();
    add_arc(source, node, 0, demand[word]);
    for (std::uint32_t unit = 0; unit < costs.units; ++unit) {
      const double cost = costs.at(unit, word);
      if (cost == kImpossible || cost > limit) continue;
      add_arc(node, units[unit], static_cast<std::int64_t>(cost) - kReward, 1);
    }
  }
  add_arc(sink, source, 0, costs.units);  // a circulation: as much as pays
  lemon::NetworkSimplex<Graph, std::int64_t, std::int64_t> simplex(graph);
  Graph::ArcMap<std::int64_t> cost_map(graph);
  Graph::ArcMap<std::int64_t> room_map(graph);
  for (Graph::ArcIt arc(graph); arc != lemon::INVALID; ++arc) {
    cost_map[arc] = arc_cost[Graph::id(arc)];
    room_map[arc] = arc_room[Graph::id(arc)];
  }
  simplex.upperMap(room_map).costMap(cost_map).run();
  Optimum optimum;
  for (Graph::ArcIt arc(graph); arc != lemon::INVALID; ++arc) {
    if (arc_cost[Graph::id(arc)] >= 0 || simplex.flow(arc) == 0) continue;
    ++optimum.matched;
    optimum.sum += arc_cost[Graph::id(arc)] + kReward;
  }
  return optimum;
}

// The least limit within which as many units can be used as without a limit.
double find_bottleneck(const CostMatrix& costs, const std::vector<std::uint32_t>& demand,
                       std::int64_t matched) {
  std::set<double> values;
  for (const float cost : costs.values) {
    if (cost != kImpossible) values.insert(cost);
  }
  std::vector<double> sorted(values.begin(), values.end());
  std::size_t low = 0;
  std::size_t high = sorted.empty() ? 0 : sorted.size() - 1;
  while (low < high) {
    const std::size_t middle = (low + high) / 2;
    if (solve_by_flow(costs, demand, sorted[middle]).matched == matched) {
      high = middle;
    } else {
      low = middle + 1;
    }
  }
  return matched == 0 ? 0 : sorted[low];
}

void expect_agreement(const CostMatrix& costs, const std::vector<std::uint32_t>& demand) {
  const Optimum least = solve_by_flow(costs, demand, kImpossible);
  const Assignment sum = assign_least_sum(costs, demand);
  EXPECT_EQ(sum.matched, least.matched);
  EXPECT_EQ(sum.sum_cost, static_cast<double>(least.sum));

  const double maximum = find_bottleneck(costs, demand, least.matched);
  const Optimum within = solve_by_flow(costs, demand, maximum);
  const Assignment bottleneck = assign_bottleneck(costs, demand);
  EXPECT_EQ(bottleneck.matched, within.matched);
  EXPECT_EQ(bottleneck.max_cost, maximum);
  EXPECT_EQ(bottleneck.sum_cost, static_cast<double>(within.sum));
}

// Real costs become integers of 2^-24 that floats hold exactly.
CostMatrix make_integer_costs(CostKind kind, std::uint32_t units, std::uint32_t words,
                              std::uint64_t seed) {
  CostMatrix costs = make_costs(kind, units, words, seed);
  if (kind == CostKind::Real) {
    for (float& cost : costs.values) cost = std::floor(cost * 0x1p24F);
  }
  return costs;
}

TEST(ExactSolver, AgreesOnDistinctWords) {
  for (const CostKind kind : kCostKinds) {
    for (const std::uint32_t size : {17U, 90U, 200U}) {
      SCOPED_TRACE(static_cast<int>(kind) * 1000 + static_cast<int>(size));
      expect_agreement(make_integer_costs(kind, size, size, size),
                       std::vector<std::uint32_t>(size, 1));
    }
  }
}

TEST(ExactSolver, AgreesWithRepeatedWords) {
  for (const CostKind kind : kCostKinds) {
    for (const std::uint32_t words : {1U, 5U, 40U}) {
      for (const std::uint32_t total : {60U, 299U, 300U, 380U}) {
        SCOPED_TRACE(static_cast<int>(kind) * 1000 + static_cast<int>(words + total));
        expect_agreement(make_integer_costs(kind, 300, words, words),
                         make_demand(words, total, words));
      }
    }
  }
}

// Most units are left alone: they are then not copies of an unwanted word.
TEST(ExactSolver, AgreesWhenFewUnitsAreWanted) {
  for (const CostKind kind : kCostKinds) {
    for (const std::uint32_t words : {1U, 7U, 40U}) {
      for (const std::uint32_t total : {40U, 99U, 100U, 101U}) {
        SCOPED_TRACE(static_cast<int>(kind) * 1000 + static_cast<int>(words + total));
        expect_agreement(make_integer_costs(kind, 200, words, total),
                         make_demand(words, total, words + total));
      }
    }
  }
}

TEST(ExactSolver, AgreesWhenFewPairsArePossible) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const auto units = static_cast<std::uint32_t>(40 + random_bits(seed, 30, 0) % 80);
    const auto words = static_cast<std::uint32_t>(5 + random_bits(seed, 30, 1) % 100);
    const auto total = static_cast<std::uint32_t>(random_bits(seed, 30, 2) % 160);
    const double share = 0.01 + 0.1 * random_unit(seed, 30, 3);
    CostMatrix costs = make_costs(CostKind::Integers, units, words, seed);
    for (std::size_t k = 0; k < costs.values.size(); ++k) {
      if (random_unit(seed, 31, k) > share) costs.values[k] = kImpossible;
    }
    SCOPED_TRACE(seed);
    expect_agreement(costs, make_demand(words, total, seed));
  }
}

TEST(ExactSolver, AgreesOnClusteredAndSortedUnits) {
  // Cheap units side by side, and words that all want the same ones.
  for (const std::uint32_t words : {150U, 12U}) {
    CostMatrix costs = make_costs(CostKind::Integers, 150, words, 9);
    for (std::uint32_t word = 0; word < words; ++word) {
      for (std::uint32_t unit = 0; unit < 150; ++unit) {
        float& cost = costs.values[word * 150 + unit];
        cost = std::floor(cost / 100) + static_cast<float>(unit * (word % 3 + 1));
      }
    }
    expect_agreement(costs, std::vector<std::uint32_t>(words, 150 / words));
    expect_agreement(costs, make_demand(words, 100, 1));
  }
}

}  // namespace
}  // namespace triglyph
