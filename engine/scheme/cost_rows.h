// Fills a cost matrix unit by unit, as schemes compute costs, although it is stored word by word.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "engine/assignment/cost_matrix.h"
#include "engine/base/parallel.h"

namespace triglyph {

// Returns a matrix of `units` rows and `words` columns. fill_row(row, costs) sets the costs of one
// unit, which are infeasible until then; it is called in parallel, once for each row. A block of
// rows is written at once, whole cache lines of a column at a time. O(units * words).
template <typename FillRow>
CostMatrix fill_cost_rows(std::size_t units, std::size_t words, const FillRow& fill_row) {
  constexpr std::size_t kRows = 16;  // floats of a cache line
  CostMatrix matrix{static_cast<std::uint32_t>(units), static_cast<std::uint32_t>(words), {}};
  matrix.values.resize(units * words);
  parallel_for((units + kRows - 1) / kRows, [&](std::size_t block) {
    const std::size_t begin = block * kRows;
    const std::size_t count = std::min(kRows, units - begin);
    std::vector<float> rows(count * words, kInfeasible);
    for (std::size_t k = 0; k < count; ++k) {
      fill_row(begin + k, std::span<float>(rows).subspan(k * words, words));
    }
    for (std::size_t word = 0; word < words; ++word) {
      float* column = matrix.values.data() + word * units + begin;
      for (std::size_t k = 0; k < count; ++k) column[k] = rows[k * words + word];
    }
  });
  return matrix;
}

}  // namespace triglyph
