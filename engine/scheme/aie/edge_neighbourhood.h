// The neighbourhood of an edge as AIE reads it: four basis points and four groups of neighbours.
//
//            .------ c ------.          a -> b: the edge, in the direction it is read;
//             \  A  / \  C  /           c: apex of the face to its left, d: to its right.
//              \   /   \   /            The outer apex behind c-a joins the group of a, behind
//               \ /     \ /             b-c that of c, behind d-b that of b, behind a-d that
//                a ----- b              of d: reading the edge the other way round exchanges
//               / \     / \             a with b and c with d, and the groups with them.
//              /   \   /   \            .
//             /  D  \ /  B  \           .
//            '------ d ------'
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>

#include "engine/scheme/scheme.h"

namespace triglyph {

// The neighbours that carry a group's bits.
enum class GroupRule {
  OuterApexes,          // one a group: the apexes behind the four outer edges
  MiddleNeighbours,     // one a group: of the neighbours of one basis point alone, the middle one
  ExclusiveNeighbours,  // all neighbours of one basis point alone
  NeighboursAndApexes,  // these, and the outer apex
};

struct EdgeNeighbourhood {
  static constexpr std::size_t kMaxPoints = 32;

  std::array<std::uint32_t, 4> basis{};  // a, b, c, d
  std::array<std::size_t, 5> ends{};     // group k is points[ends[k]] .. points[ends[k + 1] - 1]
  std::array<std::uint32_t, kMaxPoints> points{};

  [[nodiscard]] std::span<const std::uint32_t> group(std::size_t k) const {
    return {points.data() + ends[k], points.data() + ends[k + 1]};
  }
  [[nodiscard]] std::span<const std::uint32_t> all_groups() const {
    return {points.data(), points.data() + ends[4]};
  }
};

// How an edge is read: along its first halfedge or its second, or along the first in the surface
// whose triangles are wound the other way.
enum class EdgeWay { Forward, Backward, TurnedOver };

// Is called for each group in turn as soon as its points are known. Returns false if the
// neighbourhood is not wanted.
using GroupVisit = std::function<bool(std::size_t group, std::span<const std::uint32_t> points)>;

// Returns the neighbourhood of an interior edge. Forward and backward have the same points: group k
// of the one is group k ^ 1 of the other. Returns nothing at a
// boundary, where a group would be empty, where points coincide, where the groups have more than
// kMaxPoints points, or as soon as `visit`, where given, returns false. O(1): a ring that is walked
// has at most kMaxPoints points.
[[nodiscard]] std::optional<EdgeNeighbourhood> neighbourhood_of(const Surface& surface,
                                                                std::uint32_t edge, EdgeWay way,
                                                                GroupRule rule,
                                                                const GroupVisit& visit = {});

// Returns the points a, b, c, d of an edge; nothing at a boundary or where the edge's two faces
// share all their points. O(1).
[[nodiscard]] std::optional<std::array<std::uint32_t, 4>> basis_of(const Surface& surface,
                                                                   std::uint32_t edge, EdgeWay way);

}  // namespace triglyph
