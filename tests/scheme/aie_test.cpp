#include "engine/scheme/aie/aie.h"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "engine/base/random.h"
#include "engine/marking/extract.h"
#include "engine/marking/mark.h"
#include "engine/marking/settle.h"
#include "engine/scheme/registry.h"
#include "tests/support/attacks.h"
#include "tests/support/shapes.h"

namespace triglyph {
namespace {

const Message kMessage{'a', 'f', 'f', 'i', 'n', 'e', ' ', '8'};

MarkOptions options_with(AieGroups groups) {
  MarkOptions options = default_mark_options("aie", false);
  options.scheme_options["aie_groups"] =
      std::string(kAieGroupNames.at(static_cast<std::size_t>(groups)));
  return options;
}

Mesh marked_ball(const MarkOptions& options) {
  const Marking marking =
      mark(test::bumpy_ball().surface(), kMessage, Key::trial(), options, test::as_float, 1e-7);
  EXPECT_EQ(marking.status, MarkStatus::Marked);
  return {marking.positions, test::bumpy_ball().mesh.triangles};
}

std::optional<Message> read(const Mesh& mesh, const MarkOptions& options) {
  const test::Solid solid(mesh);
  const WordCode code(Key::trial(), options.format);
  return extract(solid.surface(), options.encoding(), Key::trial()).message;
}

// Interior edge of a grid whose points are all of valence six.
std::uint32_t middle_edge(const test::Solid& grid, std::uint32_t from, std::uint32_t to) {
  Halfedge spoke = grid.halfedges.outgoing(from);
  while (grid.halfedges.to(spoke) != to) spoke = grid.halfedges.turned(spoke);
  return grid.halfedges.edge(spoke);
}

//  30 31 32 33 34 35      every square is cut from lower left to upper right
//  24 25 26 27 28 29
//  18 19 20 21 22 23
//  12 13 14 15 16 17
//   6  7  8  9 10 11
TEST(EdgeNeighbourhood, GroupsNeighboursOfARegularEdge) {
  const test::Solid grid(test::flat_grid(5, 5));
  const std::uint32_t edge = middle_edge(grid, 14, 15);
  const auto forward =
      neighbourhood_of(grid.surface(), edge, EdgeWay::Forward, GroupRule::OuterApexes);
  const auto backward =
      neighbourhood_of(grid.surface(), edge, EdgeWay::Backward, GroupRule::OuterApexes);
  ASSERT_TRUE(forward && backward);
  const auto& along = forward->basis[0] == 14 ? *forward : *backward;
  const auto& against = forward->basis[0] == 14 ? *backward : *forward;
  EXPECT_EQ(along.basis, (std::array<std::uint32_t, 4>{14, 15, 21, 8}));
  EXPECT_EQ(against.basis, (std::array<std::uint32_t, 4>{15, 14, 8, 21}));
  const std::vector<std::uint32_t> apexes{20, 9, 22, 7};
  EXPECT_TRUE(std::equal(apexes.begin(), apexes.end(), along.all_groups().begin(),
                         along.all_groups().end()));
  const std::vector<std::uint32_t> swapped{9, 20, 7, 22};
  EXPECT_TRUE(std::equal(swapped.begin(), swapped.end(), against.all_groups().begin(),
                         against.all_groups().end()));

  const auto exclusive = neighbourhood_of(
      grid.surface(), edge, along.basis == forward->basis ? EdgeWay::Forward : EdgeWay::Backward,
      GroupRule::ExclusiveNeighbours);
  ASSERT_TRUE(exclusive);
  const auto group = [](const EdgeNeighbourhood& around, std::size_t k) {
    const auto points = around.group(k);
    return std::set<std::uint32_t>(points.begin(), points.end());
  };
  EXPECT_EQ(group(*exclusive, 0), (std::set<std::uint32_t>{13}));
  EXPECT_EQ(group(*exclusive, 1), (std::set<std::uint32_t>{16}));
  EXPECT_EQ(group(*exclusive, 2), (std::set<std::uint32_t>{27, 28}));
  EXPECT_EQ(group(*exclusive, 3), (std::set<std::uint32_t>{1, 2}));
  const auto both = neighbourhood_of(
      grid.surface(), edge, along.basis == forward->basis ? EdgeWay::Forward : EdgeWay::Backward,
      GroupRule::NeighboursAndApexes);
  ASSERT_TRUE(both);
  EXPECT_EQ(group(*both, 0), (std::set<std::uint32_t>{13, 20}));
  EXPECT_EQ(group(*both, 2), (std::set<std::uint32_t>{22, 27, 28}));
}

std::set<std::uint32_t> neighbours_of(const Mesh& mesh, std::uint32_t point) {
  std::set<std::uint32_t> neighbours;
  for (const Triangle& triangle : mesh.triangles) {
    if (std::find(triangle.begin(), triangle.end(), point) == triangle.end()) continue;
    neighbours.insert(triangle.begin(), triangle.end());
  }
  neighbours.erase(point);
  return neighbours;
}

// By sets, on a surface of all valences from three on.
TEST(EdgeNeighbourhood, ExclusiveNeighboursAreThoseOfOneBasisPointAlone) {
  Mesh mesh = make_sample_shape(SampleShape::HighGenus, 1000, 5);
  for (std::size_t t = 0; t < 40; ++t) {  // a point amid each of some faces
    const Triangle cut = mesh.triangles[7 * t];
    const auto middle = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.push_back(
        (mesh.positions[cut[0]] + mesh.positions[cut[1]] + mesh.positions[cut[2]]) / 3.0);
    mesh.triangles[7 * t] = {cut[0], cut[1], middle};
    mesh.triangles.push_back({cut[1], cut[2], middle});
    mesh.triangles.push_back({cut[2], cut[0], middle});
  }
  const test::Solid solid(mesh);
  std::vector<std::set<std::uint32_t>> next_to;
  for (std::uint32_t i = 0; i < mesh.positions.size(); ++i) {
    next_to.push_back(neighbours_of(mesh, i));
  }
  std::size_t found = 0;
  for (std::uint32_t edge = 0; edge < solid.halfedges.edge_count(); ++edge) {
    const auto basis = basis_of(solid.surface(), edge, EdgeWay::Forward);
    ASSERT_TRUE(basis);
    std::array<std::set<std::uint32_t>, 4> alone;
    for (std::size_t k = 0; k < 4; ++k) {
      for (const std::uint32_t point : next_to[(*basis)[k]]) {
        const auto is_next = [&](std::uint32_t b) { return next_to[b].contains(point); };
        const bool in_basis = std::find(basis->begin(), basis->end(), point) != basis->end();
        if (!in_basis && std::count_if(basis->begin(), basis->end(), is_next) == 1) {
          alone[k].insert(point);
        }
      }
    }
    const auto around =
        neighbourhood_of(solid.surface(), edge, EdgeWay::Forward, GroupRule::ExclusiveNeighbours);
    const bool none_empty =
        std::none_of(alone.begin(), alone.end(), [](const auto& group) { return group.empty(); });
    ASSERT_EQ(around.has_value(), none_empty);
    if (!around) continue;
    ++found;
    for (std::size_t k = 0; k < 4; ++k) {
      const auto group = around->group(k);
      EXPECT_EQ(std::set<std::uint32_t>(group.begin(), group.end()), alone[k]);
      EXPECT_EQ(group.size(), alone[k].size());
    }
  }
  EXPECT_GT(found, 300U);
}

TEST(EdgeNeighbourhood, NeedsASurfaceAllAround) {
  const test::Solid grid(test::flat_grid(5, 5));
  for (const GroupRule rule : {GroupRule::OuterApexes, GroupRule::MiddleNeighbours}) {
    EXPECT_FALSE(neighbourhood_of(grid.surface(), middle_edge(grid, 0, 1), EdgeWay::Forward, rule));
    EXPECT_FALSE(neighbourhood_of(grid.surface(), middle_edge(grid, 0, 6), EdgeWay::Forward, rule));
  }
}

TEST(Aie, BasesMayBeSharedButAreNeverMoved) {
  const auto& ball = test::bumpy_ball();
  const MarkOptions options = options_with(AieGroups::One);
  const auto scheme =
      make_scheme("aie", WordCode(Key::trial(), options.format), options.scheme_options);
  const UnitSet units = scheme->bind(ball.surface())->find_units();
  for (std::size_t i = 0; i < units.size(); ++i) {
    EXPECT_EQ(units.moved[i].size(), 4U);
    EXPECT_EQ(units.read[i].size(), 8U);
  }
  const std::size_t points = ball.mesh.positions.size();
  const auto exact =
      choose_layout(Conflicts(units.moved, units.read_or_moved(), points, ConflictRule::ReadWrite),
                    {})
          .size();
  const auto disjoint =
      choose_layout(
          Conflicts(units.moved, units.read_or_moved(), points, ConflictRule::SharedPoint), {})
          .size();
  EXPECT_GT(exact, disjoint);
}

TEST(Aie, MessageSurvivesAffineMapsReorderingRoundingAndCropping) {
  for (const AieGroups groups : {AieGroups::One, AieGroups::All}) {
    const MarkOptions options = options_with(groups);
    const Mesh marked = marked_ball(options);
    EXPECT_EQ(read(marked, options), kMessage);
    EXPECT_EQ(read(test::with_significant_digits(marked, 6), options), kMessage);
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
      const bool reflect = seed % 2 == 0;
      const double condition = 1 + 3 * static_cast<double>(seed) / 8;
      EXPECT_EQ(read(test::affinely_mapped(marked, condition, reflect, seed), options), kMessage);
      EXPECT_EQ(read(test::shuffled(marked, seed), options), kMessage);
      EXPECT_EQ(read(test::cropped_half(marked, seed), options), kMessage);
    }
    const Mesh battered =
        test::affinely_mapped(test::cropped_half(test::shuffled(marked, 1), 2), 4, true, 3);
    EXPECT_EQ(read(battered, options), kMessage);
  }
}

// Alternatives of one edge may hold the same points, and then both read the same word.
TEST(Aie, NoUnitIsReadTwice) {
  for (const AieGroups groups : {AieGroups::One, AieGroups::All}) {
    const MarkOptions options = options_with(groups);
    const WordCode code(Key::trial(), options.format);
    const auto& ball = test::bumpy_ball();
    const Marking marking =
        mark(ball.surface(), kMessage, Key::trial(), options, test::as_float, 1e-7);
    const Mesh marked{marking.positions, ball.mesh.triangles};
    const Extraction found = extract({marked, ball.halfedges}, options.encoding(), Key::trial());
    EXPECT_GE(found.agreeing, marking.carriers.size());
    EXPECT_LE(found.agreeing, marking.carriers.size() * 21 / 20);  // some by chance
  }
}

// With nested groupings one reading of an edge may count in place of the other, which was not asked
// for.
TEST(Aie, ReadAtFindsOfNestedGroupingsTheOneThatReadFinds) {
  const MarkOptions options = options_with(AieGroups::All);
  const test::Solid marked(marked_ball(options));
  const auto scheme =
      make_scheme("aie", WordCode(Key::trial(), options.format), options.scheme_options);
  const auto bound = scheme->bind(marked.surface());
  const std::vector<Reading> all = bound->read();
  std::vector<std::uint32_t> found, others;  // anchors
  for (const Reading& reading : all) found.push_back(reading.anchor);
  for (const std::uint32_t anchor : found) {
    const std::uint32_t other = anchor ^ 1;
    if (!std::binary_search(found.begin(), found.end(), other)) others.push_back(other);
  }
  ASSERT_GT(others.size(), 100U);
  EXPECT_TRUE(bound->read_at(others).empty());
  EXPECT_EQ(bound->read_at(found).size(), all.size());
}

// A group of several points outlives the loss of some of them: as large a share of the points that
// carry the mark is damaged, and a larger share of the units still agrees.
TEST(Aie, AllNeighboursOutliveDamageThatOneDoesNot) {
  const auto surviving = [](AieGroups groups) {
    const MarkOptions options = options_with(groups);
    const WordCode code(Key::trial(), options.format);
    const auto scheme = make_scheme("aie", code, options.scheme_options);
    const auto& ball = test::bumpy_ball();
    const Marking marking =
        mark(ball.surface(), kMessage, Key::trial(), options, test::as_float, 1e-7);
    Mesh damaged{marking.positions, ball.mesh.triangles};
    for (std::size_t i = 0; i < damaged.positions.size(); ++i) {
      const bool carries = marking.positions[i] != ball.mesh.positions[i];
      if (carries && random_unit(3, i, 0) < 0.1) damaged.positions[i] *= 1.002;
    }
    const Extraction found = extract(*scheme->bind({damaged, ball.halfedges}), code);
    EXPECT_EQ(found.message, kMessage);
    return static_cast<double>(found.agreeing) / static_cast<double>(marking.carriers.size());
  };
  EXPECT_GT(surviving(AieGroups::All), surviving(AieGroups::One));
}

// CAD parts: subdivided planes, where the norm in space does not exist.
TEST(Aie, MarksFlatRegionsInTheirPlane) {
  Mesh mesh = test::flat_grid(40, 40);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    Vec3& p = mesh.positions[i];
    if (p[0] == 0 || p[1] == 0 || p[0] == 40 || p[1] == 40) continue;
    p += Vec3(random_unit(1, i, 0) - 0.5, random_unit(1, i, 1) - 0.5, 0) * 0.5;
  }
  const test::Solid sheet(mesh);
  const MarkOptions options = options_with(AieGroups::One);
  const Marking marking = mark(
      sheet.surface(), kMessage, Key::trial(), options, [](const Vec3& p) { return p; }, 0);
  ASSERT_EQ(marking.status, MarkStatus::Marked);
  for (const Vec3& p : marking.positions) EXPECT_EQ(p[2], 0);
  EXPECT_TRUE(flipped_triangles(mesh.triangles, mesh.positions, marking.positions).empty());
  const Mesh marked{marking.positions, mesh.triangles};
  EXPECT_EQ(read(marked, options), kMessage);
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const Mesh mapped = test::affinely_mapped(marked, 4, seed % 2 == 0, seed);
    EXPECT_EQ(read(test::with_significant_digits(mapped, 9), options), kMessage);
  }
}

TEST(Aie, LessThanAQuarterOfTheUnoptimisedMove) {
  MarkOptions optimised = default_mark_options("aie", true);
  MarkOptions plain = optimised;
  plain.layout.method = LayoutMethod::FirstFit;
  plain.assign = AssignMethod::Sequential;
  const auto fill = [](const MarkOptions& options) {
    return mark(test::bumpy_ball().surface(), Fill{}, Key::trial(), options, test::as_float, 1e-7);
  };
  const Marking before = fill(plain);
  const Marking after = fill(optimised);
  EXPECT_LT(after.cost_max, 0.25 * before.cost_max);
  EXPECT_GT(after.units_valid, before.units_valid);
  EXPECT_GE(after.carriers.size(), after.units_valid * 95 / 100);
}

TEST(Aie, RefusesWordsThatDoNotFit) {
  const AieOptions options;
  EXPECT_THROW(AieScheme(WordCode(Key::trial(), {11, 11, 11}), options), Error);
  EXPECT_NO_THROW(AieScheme(WordCode(Key::trial(), {5, 9, 10}), options));
  EXPECT_NO_THROW(AieScheme(WordCode(Key::trial(), {3, 3, 5}), options));
}

}  // namespace
}  // namespace triglyph
