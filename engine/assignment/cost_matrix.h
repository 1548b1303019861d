// What it costs to hide each word in each unit: one column of floats a word.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace triglyph {

struct CostMatrix {
  std::uint32_t units = 0;
  std::uint32_t words = 0;
  std::vector<float> values;  // values[word * units + unit]; >= 0, or +infinity where impossible

  [[nodiscard]] float at(std::uint32_t unit, std::uint32_t word) const {
    return values[static_cast<std::size_t>(word) * units + unit];
  }
  [[nodiscard]] std::span<const float> column(std::uint32_t word) const {
    return {values.data() + static_cast<std::size_t>(word) * units, units};
  }
};

}  // namespace triglyph
