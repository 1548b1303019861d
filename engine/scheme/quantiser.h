// Quantisation index modulation of one scalar invariant. The line is cut into cells of width
// `step`, shifted by a keyed offset; the cells carry b bits cyclically in Gray order, so that a
// value which slips into a neighbouring cell loses one bit. All schemes use it.
//
// Chen, Wornell. Quantization index modulation. IEEE Transactions on Information Theory 47 (2001).
#pragma once

#include <cmath>
#include <cstdint>

namespace triglyph {

class Quantiser {
 public:
  // The bits of the cell in which a value lies, and the value's distance from the cell's centre: 0
  // at the centre, 1 at the border.
  struct Cell {
    std::uint32_t bits = 0;
    float distance = 0;
  };

  // Preconditions: step > 0, in units of the invariant; 0 <= bits <= 16; 0 <= offset < 1, in cells.
  Quantiser(double step, int bits, double offset) noexcept
      : step_(step), offset_(offset), bits_(bits), mask_((std::int64_t{1} << bits) - 1) {}

  [[nodiscard]] int bits() const noexcept { return bits_; }
  [[nodiscard]] double step() const noexcept { return step_; }
  // Returns the distance between neighbouring cells of the same bits, in units of the invariant.
  [[nodiscard]] double period() const noexcept { return step_ * static_cast<double>(mask_ + 1); }

  [[nodiscard]] Cell cell_of(double value) const noexcept {
    const double position = value / step_ + offset_;
    if (!(std::abs(position) < 0x1p50)) return {0, 1};  // degenerate shapes: beyond any cell, NaN
    const double floor = std::floor(position);
    const auto residue = static_cast<std::uint32_t>(static_cast<std::int64_t>(floor) & mask_);
    return {residue ^ (residue >> 1), static_cast<float>(std::abs(2 * (position - floor) - 1))};
  }

  // Returns the centre nearest to `value` among the cells that carry these bits. O(1).
  [[nodiscard]] double nearest_centre(double value, std::uint32_t bits) const noexcept {
    const double base = (static_cast<double>(residue_of(bits)) + 0.5 - offset_) * step_;
    return base + std::round((value - base) / period()) * period();
  }

  // Returns the next such centre on the other side of `value`. O(1).
  [[nodiscard]] double second_centre(double value, double nearest) const noexcept {
    return nearest <= value ? nearest + period() : nearest - period();
  }

 private:
  // Inverts the Gray code.
  [[nodiscard]] static std::uint32_t residue_of(std::uint32_t gray) noexcept {
    for (std::uint32_t shift = 1; shift < 32; shift <<= 1) gray ^= gray >> shift;
    return gray;
  }

  double step_;
  double offset_;
  int bits_;
  std::int64_t mask_;
};

}  // namespace triglyph
