// The cost matrix: the cost of each invariant unit (row) carrying each watermark word (column).
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace triglyph {

inline constexpr float kInfeasible = std::numeric_limits<float>::infinity();

struct CostMatrix {
  std::uint32_t units = 0;
  std::uint32_t words = 0;
  std::vector<float> values;  // column-major: values[word * units + unit], >= 0 or kInfeasible

  [[nodiscard]] float at(std::uint32_t unit, std::uint32_t word) const {
    return values[std::size_t{word} * units + unit];
  }
  [[nodiscard]] std::span<const float> column(std::uint32_t word) const {
    return {values.data() + std::size_t{word} * units, units};
  }
};

}  // namespace triglyph
