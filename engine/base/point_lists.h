// Lists of point indices, one list per unit, in compressed rows (CSR).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace triglyph {

// List i is points[offsets[i]] .. points[offsets[i + 1] - 1].
struct PointLists {
  std::vector<std::uint32_t> offsets{0};
  std::vector<std::uint32_t> points;

  [[nodiscard]] std::size_t size() const { return offsets.size() - 1; }
  void append(std::span<const std::uint32_t> list) {
    points.insert(points.end(), list.begin(), list.end());
    offsets.push_back(static_cast<std::uint32_t>(points.size()));
  }
  void append(const PointLists& lists) {
    const auto shift = static_cast<std::uint32_t>(points.size());
    points.insert(points.end(), lists.points.begin(), lists.points.end());
    for (std::size_t i = 1; i < lists.offsets.size(); ++i) {
      offsets.push_back(shift + lists.offsets[i]);
    }
  }
  [[nodiscard]] std::span<const std::uint32_t> operator[](std::size_t i) const {
    return {points.data() + offsets[i], points.data() + offsets[i + 1]};
  }
};

}  // namespace triglyph
