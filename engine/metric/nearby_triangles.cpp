#include "engine/metric/nearby_triangles.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include "engine/base/parallel.h"
#include "engine/geometry/box.h"

namespace triglyph {
namespace {

constexpr double kCellsAcross = 16;  // most cells along a side of the largest box: bounds the work

// Returns the bounding box of a triangle before and after, widened by the greatest move of its
// corners.
Box swept_box(const Triangle& triangle, std::span<const Vec3> before, std::span<const Vec3> after) {
  Box box;
  double reach_squared = 0;
  for (const std::uint32_t point : triangle) {
    box.extend(before[point]);
    box.extend(after[point]);
    reach_squared = std::max(reach_squared, (after[point] - before[point]).sqrnorm());
  }
  const double reach = std::sqrt(reach_squared);
  box.low -= Vec3(reach, reach, reach);
  box.high += Vec3(reach, reach, reach);
  return box;
}

// The set of grid cells that boxes touch, as a hashed bit set. A collision makes a cell look
// touched, which can keep a triangle too many but never loses one.
class TouchedCells {
 public:
  // Reserves room for `boxes` calls of touch() with boxes about as wide as a cell.
  TouchedCells(const Vec3& origin, double cell, std::size_t boxes)
      : origin_(origin),
        cell_(cell),
        slots_(std::bit_ceil(std::clamp(boxes * kSlotsPerBox, kFewestSlots, kMostSlots))),
        bits_(slots_ / 64, 0) {}

  void touch(const Box& box) {
    visit_slots(cells_of(box), [&](std::size_t slot) {
      bits_[slot / 64] |= std::uint64_t{1} << (slot % 64);
      return false;
    });
  }

  [[nodiscard]] bool touches(const Box& box) const {
    const Cells cells = cells_of(box);
    double count = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) count *= cells.high[axis] - cells.low[axis] + 1;
    if (!(count <= kMostCells))
      return true;  // a triangle this large is kept without a look at its cells
    return visit_slots(
        cells, [&](std::size_t slot) { return ((bits_[slot / 64] >> (slot % 64)) & 1) != 0; });
  }

 private:
  static constexpr std::size_t kSlotsPerBox = 1024;  // enough that collisions are rare
  static constexpr std::size_t kFewestSlots = std::size_t{1} << 16;
  static constexpr std::size_t kMostSlots = std::size_t{1} << 26;
  static constexpr double kMostCells = 1000;

  struct Cells {
    std::array<double, 3> low{}, high{};  // cell coordinates, integers
  };

  [[nodiscard]] Cells cells_of(const Box& box) const {
    Cells cells;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      cells.low[axis] = std::floor((box.low[axis] - origin_[axis]) / cell_);
      cells.high[axis] = std::floor((box.high[axis] - origin_[axis]) / cell_);
    }
    return cells;
  }

  // Visits the slots of a range of cells until `visit` returns true.
  template <typename Visit>
  bool visit_slots(const Cells& cells, const Visit& visit) const {
    for (auto x = whole(cells.low[0]); x <= whole(cells.high[0]); ++x) {
      for (auto y = whole(cells.low[1]); y <= whole(cells.high[1]); ++y) {
        for (auto z = whole(cells.low[2]); z <= whole(cells.high[2]); ++z) {
          if (visit(slot_of(x, y, z))) return true;
        }
      }
    }
    return false;
  }

  [[nodiscard]] static std::int64_t whole(double value) { return static_cast<std::int64_t>(value); }

  [[nodiscard]] std::size_t slot_of(std::int64_t x, std::int64_t y, std::int64_t z) const {
    const std::uint64_t hash = static_cast<std::uint64_t>(x) * 0x9e3779b97f4a7c15ULL ^
                               static_cast<std::uint64_t>(y) * 0xc2b2ae3d27d4eb4fULL ^
                               static_cast<std::uint64_t>(z) * 0x165667b19e3779f9ULL;
    return static_cast<std::size_t>((hash >> 24) & (slots_ - 1));
  }

  Vec3 origin_;
  double cell_;
  std::size_t slots_;
  std::vector<std::uint64_t> bits_;
};

}  // namespace

std::vector<Triangle> nearby_triangles(std::span<const Triangle> triangles,
                                       std::span<const Triangle> moved,
                                       std::span<const Vec3> before, std::span<const Vec3> after) {
  if (moved.empty()) return {};
  std::vector<Box> boxes;
  boxes.reserve(moved.size());
  double largest = 0;
  double sum = 0;
  Box around;
  for (const Triangle& triangle : moved) {
    boxes.push_back(swept_box(triangle, before, after));
    around.extend(boxes.back());
    const double width = boxes.back().size().max();
    largest = std::max(largest, width);
    sum += width;
  }
  // beyond this, cell coordinates would not be exact
  if (!(largest > 0 && around.size().max() < 1e12 * largest)) {
    return {triangles.begin(), triangles.end()};
  }
  // as wide as the average box, but not so narrow that the largest box touches too many cells
  const double cell = std::max(sum / static_cast<double>(moved.size()), largest / kCellsAcross);
  TouchedCells touched(around.low, cell, moved.size());
  for (const Box& box : boxes) touched.touch(box);
  return parallel_collect<Triangle>(
      triangles.size(), [&](std::size_t t, std::vector<Triangle>& out) {
        const Box box = swept_box(triangles[t], before, after);
        const bool apart = (box.low - around.high).max() > 0 || (around.low - box.high).max() > 0;
        if (!apart && touched.touches(box)) out.push_back(triangles[t]);
      });
}

}  // namespace triglyph
