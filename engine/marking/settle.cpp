#include "engine/marking/settle.h"

#include <algorithm>

#include "engine/base/parallel.h"

namespace triglyph {
namespace {

// An invariant farther than this from its cell's centre, in half cells, would not survive another
// rounding of the same size.
constexpr float kMaxOffset = 0.5F;

constexpr std::uint32_t kNobody = 0xffffffff;

// The placements that still stand, and who moved which point.
class Placed {
 public:
  Placed(const Surface& surface, const UnitSet& units, std::span<const Placement> placements,
         std::vector<Vec3>& positions)
      : surface_(surface),
        units_(units),
        placements_(placements),
        positions_(positions),
        stands_(placements.size(), 1),
        owner_(surface.mesh.positions.size(), kNobody) {
    for (std::uint32_t i = 0; i < placements.size(); ++i) {
      for (const std::uint32_t point : moved(i)) owner_[point] = i;
    }
  }

  [[nodiscard]] bool stands(std::uint32_t placement) const { return stands_[placement] != 0; }
  [[nodiscard]] std::span<const std::uint32_t> moved(std::uint32_t placement) const {
    return units_.moved[placements_[placement].unit];
  }

  void take_back(std::uint32_t placement) {
    stands_[placement] = 0;
    for (const std::uint32_t point : moved(placement)) {
      positions_[point] = surface_.mesh.positions[point];
      owner_[point] = kNobody;
    }
  }

  // Takes back every unit that moved a corner of a flipped triangle, until there is none.
  void take_back_flips() {
    for (;;) {
      const auto flipped =
          flipped_triangles(surface_.mesh.triangles, surface_.mesh.positions, positions_);
      if (flipped.empty()) return;
      for (const std::uint32_t triangle : flipped) {
        for (const std::uint32_t point : surface_.mesh.triangles[triangle]) {
          if (owner_[point] != kNobody) take_back(owner_[point]);
        }
      }
    }
  }

 private:
  const Surface& surface_;
  const UnitSet& units_;
  std::span<const Placement> placements_;
  std::vector<Vec3>& positions_;
  std::vector<char> stands_;
  std::vector<std::uint32_t> owner_;
};

}  // namespace

std::vector<std::uint32_t> flipped_triangles(std::span<const Triangle> triangles,
                                             std::span<const Vec3> before,
                                             std::span<const Vec3> after) {
  return parallel_collect<std::uint32_t>(
      triangles.size(), [&](std::size_t t, std::vector<std::uint32_t>& out) {
        const Triangle& triangle = triangles[t];
        const bool stays = std::all_of(triangle.begin(), triangle.end(), [&](std::uint32_t point) {
          return before[point] == after[point];
        });
        if (stays) return;
        const Vec3 was = area_normal(before, triangle);
        if (dot(was, was) > 0 && !(dot(was, area_normal(after, triangle)) > 0)) {
          out.push_back(static_cast<std::uint32_t>(t));
        }
      });
}

void settle(const Surface& surface, const BoundScheme& scheme, const UnitSet& units,
            std::span<const Placement> placements, const Rounding& round, Marking& marking) {
  Embedding embedding = scheme.embed(units, placements, marking.words);
  marking.positions = std::move(embedding.positions);
  marking.carriers.clear();
  Placed placed(surface, units, placements, marking.positions);
  for (const std::uint32_t failed : embedding.failed) placed.take_back(failed);
  parallel_for(
      placements.size(),
      [&](std::size_t i) {
        const auto placement = static_cast<std::uint32_t>(i);
        if (!placed.stands(placement)) return;
        for (const std::uint32_t point : placed.moved(placement)) {
          Vec3& position = marking.positions[point];
          if (position != surface.mesh.positions[point]) position = round(position);
        }
      },
      64);
  placed.take_back_flips();

  // read what stands there now; readings and placements are both sorted by anchor
  const Mesh settled{marking.positions, surface.mesh.triangles};
  const std::vector<Reading> readings = scheme.moved_to({settled, surface.halfedges})->read();
  auto reading = readings.begin();
  for (std::uint32_t i = 0; i < placements.size(); ++i) {
    const std::uint32_t anchor = units.anchors[placements[i].unit];
    while (reading != readings.end() && reading->anchor < anchor) ++reading;
    if (!placed.stands(i)) continue;
    const bool reads = reading != readings.end() && reading->anchor == anchor &&
                       reading->word == marking.words[placements[i].word] &&
                       reading->worst_offset <= kMaxOffset;
    if (reads) {
      marking.carriers.push_back({anchor, placements[i].word});
    } else {
      placed.take_back(i);
    }
  }
  placed.take_back_flips();
  std::erase_if(marking.carriers, [&](const Carrier& carrier) {
    const auto at = std::lower_bound(
        placements.begin(), placements.end(), carrier.anchor,
        [&](const Placement& p, std::uint32_t anchor) { return units.anchors[p.unit] < anchor; });
    return !placed.stands(static_cast<std::uint32_t>(at - placements.begin()));
  });
  marking.units_dropped = static_cast<std::uint32_t>(placements.size() - marking.carriers.size());
}

}  // namespace triglyph
