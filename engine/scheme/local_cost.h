// What a local change of the surface costs: the quantity that assignment minimises. A unit is cut
// into parts that move on their own (TSQ: M and three apexes, AIE: four groups, IIE: the cap); a
// part is weighed alone, the others where they were, and the parts are combined.
//
// To add a function: name it in CostFunction and kCostNames, give it a case in of_part() and, if
// parts do not combine by their maximum, in combine(). Schemes need no change.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>

#include "engine/geometry/spatial_index.h"
#include "engine/scheme/scheme.h"
#include "engine/scheme/scheme_options.h"

namespace triglyph {

struct Move {
  std::uint32_t point = 0;
  Vec3 to{0, 0, 0};
};

class LocalCost {
 public:
  // The surface must outlive the cost. Hausdorff builds a spatial index: O(t log t).
  LocalCost(const Surface& surface, CostFunction function);

  // Model units; for rms their squares, added up. O(moves * valence).
  [[nodiscard]] float of_part(std::span<const Move> moves) const;

  // Is the cost of a part that moves one point by this distance known from the distance alone?
  [[nodiscard]] bool goes_by_distance() const {
    return function_ == CostFunction::Displacement || function_ == CostFunction::Rms;
  }
  [[nodiscard]] float of_distance(float distance) const {
    return function_ == CostFunction::Rms ? distance * distance : distance;
  }

  // Of a unit from its parts, which move so many points. Model units.
  [[nodiscard]] float combine(std::span<const float> parts, std::size_t points) const {
    if (function_ != CostFunction::Rms) return *std::max_element(parts.begin(), parts.end());
    float sum = 0;
    for (const float part : parts) sum += part;
    return std::sqrt(sum / static_cast<float>(points));
  }

 private:
  [[nodiscard]] double surface_distance(std::span<const Move> moves) const;
  [[nodiscard]] double normal_change(std::span<const Move> moves) const;

  const Surface& surface_;
  CostFunction function_;
  std::optional<SpatialIndex> index_;  // of the unmoved surface
};

}  // namespace triglyph
