// From ideal positions to those a file will hold: what the mark does to a mesh must survive
// rounding and must not turn a face over. Units that fail are put back as they were.
#pragma once

#include "engine/marking/marking.h"

namespace triglyph {

// Triangles whose normal turned by more than a right angle, or that lost all area, because a corner
// moved; triangles without area before are left out. Ascending. O(triangles).
[[nodiscard]] std::vector<std::uint32_t> flipped_triangles(std::span<const Triangle> triangles,
                                                           std::span<const Vec3> before,
                                                           std::span<const Vec3> after);

// What the positions of a marked mesh must comply with.
struct SettleRules {
  const Rounding& round;  // to what the output can hold
  double max_move = 0;    // the farthest that a point may move, after rounding; 0: no limit
  const Recut& recut;     // how faces are cut into triangles
};

// Embeds the placements, rounds what moved, and takes units back until no point moved too far, no
// face is flipped or cut otherwise and every unit left reads its word with margin. Fills positions,
// carriers and units_dropped of `marking`, whose words the placements index. `scheme` is bound to
// `surface`.
void settle(const Surface& surface, const BoundScheme& scheme, const UnitSet& units,
            std::span<const Placement> placements, const SettleRules& rules, Marking& marking);

}  // namespace triglyph
