// The cost of a local change of the surface, which assignment minimises. A unit consists of parts
// that move on their own (TSQ: M and three apexes, AIE: four groups, IIE: the cap). Each part is
// weighed alone, as if the others had not moved, and the costs of the parts are combined.
//
// To add a function, name it in CostFunction and kCostNames, give it a case in of_part() and, if
// the parts do not combine by their maximum, in combine(). Schemes need no change.
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
  // The surface must outlive the cost. For Hausdorff a spatial index is built, O(t log t) for t
  // triangles.
  LocalCost(const Surface& surface, CostFunction function);

  // Returns the cost of moving these points, model units; under Rms the sum of the squared moves.
  // O(moves) for Displacement and Rms, O(moves * valence) for the others.
  [[nodiscard]] float of_part(std::span<const Move> moves) const;

  // Says whether the cost of moving a single point depends on the distance alone.
  [[nodiscard]] bool goes_by_distance() const {
    return function_ == CostFunction::Displacement || function_ == CostFunction::Rms;
  }
  // Returns the cost of moving a single point by this distance, model units. Precondition:
  // goes_by_distance().
  [[nodiscard]] float of_distance(float distance) const {
    return function_ == CostFunction::Rms ? distance * distance : distance;
  }

  // Returns the cost of a unit, model units, from those of its parts, which move so many points.
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
