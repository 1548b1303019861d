// The options of all schemes. Each scheme adds options of its own in its folder.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "engine/base/options.h"

namespace triglyph {

// The local change of the shape that assignment minimises, in model units. See local_cost.h.
enum class CostFunction {
  Displacement,  // the farthest move of a unit's points
  Rms,           // root mean square of the moves of a unit's points
  Hausdorff,  // between the surface about a unit before and after: sliding along it is nearly free
  Normal,     // change of a face's normal times the root of its area: what shading shows
};

// How much a mark may change a mesh, and how much it survives.
enum class Strength : std::uint8_t { Light, Normal, Strong };

// Returns the names by CostFunction: "displacement", "rms", "hausdorff", "normal".
[[nodiscard]] std::span<const std::string_view> cost_names();
[[nodiscard]] std::string_view name_of(CostFunction cost);

struct SchemeOptions {
  double step = 0.02;  // width of a quantiser cell, dimensionless
  CostFunction cost = CostFunction::Displacement;
};

// Declares the option for the width of a scheme's cells, above 0 and up to `widest`.
template <typename Options>
[[nodiscard]] Option<Options> step_option(double widest) {
  return number_option<Options>("step", &Options::step, {0, widest, true}, "", "the scheme's",
                                "Width of a quantiser cell, dimensionless");
}

}  // namespace triglyph
