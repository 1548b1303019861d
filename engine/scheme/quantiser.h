// Quantisation index modulation of one scalar invariant: the line is cut into cells of width
// `step`, shifted by a keyed offset; cells are numbered cyclically by b bits in Gray order, so that
// slipping into a neighbouring cell costs one bit. Shared by all schemes.
#pragma once

#include <cmath>
#include <cstdint>

namespace triglyph {

class Quantiser {
 public:
  // A value as it was read: the bits of its cell, and how far from the cell's centre it lies, 0 at
  // the centre and 1 at the border.
  struct Cell {
    std::uint32_t bits = 0;
    float distance = 0;
  };

  // step > 0 in units of the invariant, 0 <= bits <= 16, offset in [0, 1).
  Quantiser(double step, int bits, double offset) noexcept
      : step_(step), offset_(offset), bits_(bits), mask_((std::int64_t{1} << bits) - 1) {}

  [[nodiscard]] int bits() const noexcept { return bits_; }
  [[nodiscard]] double step() const noexcept { return step_; }
  // Distance between two cells of the same bits.
  [[nodiscard]] double period() const noexcept { return step_ * static_cast<double>(mask_ + 1); }

  [[nodiscard]] Cell cell_of(double value) const noexcept {
    const double position = value / step_ + offset_;
    if (!(std::abs(position) < 0x1p50)) return {0, 1};  // degenerate shapes: beyond any cell, NaN
    const double floor = std::floor(position);
    const auto residue = static_cast<std::uint32_t>(static_cast<std::int64_t>(floor) & mask_);
    return {residue ^ (residue >> 1), static_cast<float>(std::abs(2 * (position - floor) - 1))};
  }

  // The centre nearest to `value` of the cells that carry these bits. O(1).
  [[nodiscard]] double nearest_centre(double value, std::uint32_t bits) const noexcept {
    const double base = (static_cast<double>(residue_of(bits)) + 0.5 - offset_) * step_;
    return base + std::round((value - base) / period()) * period();
  }

  // The next such centre on the other side of `value`.
  [[nodiscard]] double second_centre(double value, double nearest) const noexcept {
    return nearest <= value ? nearest + period() : nearest - period();
  }

 private:
  // Inverse of the Gray code.
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
