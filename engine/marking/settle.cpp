#include "engine/marking/settle.h"

#include <algorithm>

#include "engine/base/parallel.h"
#include "engine/base/stop.h"

namespace triglyph {
namespace {

// An invariant farther than this from its cell's centre, in half cells, would not survive another
// rounding of the same size.
constexpr float kMaxOffset = 0.5F;

constexpr std::uint32_t kNoPlacement = 0xffffffff;

constexpr std::size_t kPlacementsPerTask = 64;  // rounding a unit's points takes a microsecond

// Which placements the positions still embed, and which of them moved which point.
class EmbeddedPlacements {
 public:
  EmbeddedPlacements(const Surface& surface, const UnitSet& units,
                     std::span<const Placement> placements, std::vector<Vec3>& positions)
      : surface_(surface),
        units_(units),
        placements_(placements),
        positions_(positions),
        embedded_(placements.size(), 1),
        mover_(surface.mesh.positions.size(), kNoPlacement) {
    for (std::uint32_t i = 0; i < placements.size(); ++i) {
      for (const std::uint32_t point : moved(i)) mover_[point] = i;
    }
  }

  // By ascending anchor.
  [[nodiscard]] std::vector<Carrier> carriers() const {
    std::vector<Carrier> carriers;
    for (std::uint32_t i = 0; i < placements_.size(); ++i) {
      if (is_embedded(i)) carriers.push_back({anchor(i), placements_[i].word});
    }
    return carriers;
  }

  // Takes every moved point to the nearest that the output can hold.
  void round_moved(const Rounding& round) {
    parallel_for(
        placements_.size(),
        [&](std::size_t i) {
          const auto placement = static_cast<std::uint32_t>(i);
          if (!is_embedded(placement)) return;
          for (const std::uint32_t point : moved(placement)) {
            Vec3& position = positions_[point];
            if (position != surface_.mesh.positions[point]) position = round(position);
          }
        },
        kPlacementsPerTask);
  }

  // Puts the points of a unit back where the surface has them.
  void take_back(std::uint32_t placement) {
    embedded_[placement] = 0;
    for (const std::uint32_t point : moved(placement)) {
      positions_[point] = surface_.mesh.positions[point];
      mover_[point] = kNoPlacement;
    }
  }

  // Takes back the units that moved a corner of a triangle. Returns how many these were.
  int take_back_movers(const Triangle& triangle) {
    int count = 0;
    for (const std::uint32_t point : triangle) {
      if (mover_[point] == kNoPlacement) continue;
      take_back(mover_[point]);
      ++count;
    }
    return count;
  }

  // Takes back every unit that moved a point farther than this.
  void take_back_far(double max_move) {
    for (std::uint32_t i = 0; i < placements_.size(); ++i) {
      if (!is_embedded(i)) continue;
      const auto points = moved(i);
      const bool is_far = std::any_of(points.begin(), points.end(), [&](std::uint32_t point) {
        return (positions_[point] - surface_.mesh.positions[point]).norm() > max_move;
      });
      if (is_far) take_back(i);
    }
  }

  // Takes back every unit that moved a corner of a flipped triangle, until there is none.
  void take_back_flips() {
    for (;;) {
      stop_point();
      const auto flipped =
          flipped_triangles(surface_.mesh.triangles, surface_.mesh.positions, positions_);
      if (flipped.empty()) return;
      for (const std::uint32_t triangle : flipped) {
        take_back_movers(surface_.mesh.triangles[triangle]);
      }
    }
  }

  // Takes back every unit that moved a corner of a face that is cut otherwise now, until there is
  // none.
  void take_back_recut(const Recut& recut) {
    const std::vector<Triangle>& before = surface_.mesh.triangles;
    for (bool is_done = !recut; !is_done;) {
      stop_point();
      const std::vector<Triangle> now = recut(positions_);
      if (now.size() != before.size()) return;  // by a face that repeats a point: cannot be told
      is_done = true;
      for (std::size_t t = 0; t < before.size(); ++t) {
        if (now[t] != before[t] && take_back_movers(before[t]) + take_back_movers(now[t]) > 0) {
          is_done = false;
        }
      }
    }
  }

  // Takes back every unit that does not read its word with margin, from the positions as they are
  // before any of these is taken back.
  void take_back_misread(const BoundScheme& scheme, std::span<const Word> words) {
    std::vector<std::uint32_t> anchors;
    for (const Carrier& carrier : carriers()) anchors.push_back(carrier.anchor);
    const Mesh settled{positions_, surface_.mesh.triangles};
    const std::vector<Reading> readings =
        scheme.moved_to({settled, surface_.halfedges})->read_at(anchors);
    auto reading = readings.begin();
    for (std::uint32_t i = 0; i < placements_.size(); ++i) {
      if (!is_embedded(i)) continue;
      const bool shows_marker = reading != readings.end() && reading->anchor == anchor(i);
      const bool carries_word = shows_marker && reading->word == words[placements_[i].word] &&
                                reading->worst_offset <= kMaxOffset;
      if (shows_marker) ++reading;
      if (!carries_word) take_back(i);
    }
  }

 private:
  [[nodiscard]] bool is_embedded(std::uint32_t placement) const {
    return embedded_[placement] != 0;
  }
  [[nodiscard]] std::uint32_t anchor(std::uint32_t placement) const {
    return units_.anchors[placements_[placement].unit];
  }
  [[nodiscard]] std::span<const std::uint32_t> moved(std::uint32_t placement) const {
    return units_.moved[placements_[placement].unit];
  }

  const Surface& surface_;
  const UnitSet& units_;
  std::span<const Placement> placements_;
  std::vector<Vec3>& positions_;
  std::vector<char> embedded_;
  std::vector<std::uint32_t> mover_;
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
            std::span<const Placement> placements, const SettleRules& rules, Marking& marking) {
  Embedding embedding = scheme.embed(units, placements, marking.words);
  marking.positions = std::move(embedding.positions);
  EmbeddedPlacements embedded(surface, units, placements, marking.positions);
  for (const std::uint32_t failed : embedding.failed) embedded.take_back(failed);
  embedded.round_moved(rules.round);
  if (rules.max_move > 0) embedded.take_back_far(rules.max_move);
  const auto take_back_misshapen = [&] {
    embedded.take_back_flips();
    embedded.take_back_recut(rules.recut);
  };
  take_back_misshapen();
  embedded.take_back_misread(scheme, marking.words);
  take_back_misshapen();
  marking.carriers = embedded.carriers();
  marking.units_dropped = static_cast<std::uint32_t>(placements.size() - marking.carriers.size());
}

}  // namespace triglyph
