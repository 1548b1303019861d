// From measured functionals to soft values, and what they prove. A functional m carries a bit b by
// lying at step * (k + dither + b / 2) for some whole k (dither modulation). The dither is the
// key's, so that the readings of a mesh without this mark are uniform in a cell, whatever the mesh:
// every bound of a false alarm here is exact over keys.
//
// This work is based on
// Chen, Wornell. Quantization index modulation. IEEE Transactions on Information Theory 47 (2001).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/flux/functionals.h"
#include "engine/message/key.h"

namespace triglyph {

// Rungs of the ladder of normalisers, powers of two from 2^-2 to 2^6.
inline constexpr int kLeastRung = -2;
inline constexpr std::size_t kRungs = 9;

// Functionals with less of the surface than this, of the mean of 64 functionals, are not used: a
// mark in them moves a small place far.
inline constexpr double kLeastShare = 0.5;

// How a reader sees one functional. A mark divides it by the power of two that is nearest to its
// share of the surface, since dividing by the share itself would bring in the noise of an area. At
// a border between two rungs, or between used and unused, a reader weighs both.
struct Measured {
  double value = 0;  // the flux over the rung, in the unit of steps
  int rung = 0;
  int other_rung = 0;       // the next nearest
  double other_weight = 0;  // the probability that a mark used that one
  double used = 0;          // the probability that a mark used the functional

  [[nodiscard]] double other_value() const;
};

// Returns what a functional's flux is divided by on a rung.
[[nodiscard]] double rung_unit(int rung);

using Measurement = std::array<Measured, kFunctionals>;

// Returns what a reader sees in the values. O(1).
[[nodiscard]] Measurement measured(const FluxValues& values);

// Returns the same with other fluxes over the same surface, as they are estimated for a surface
// before some change.
[[nodiscard]] Measurement with_fluxes(Measurement measurement, const FluxVector& fluxes);

// Keyed shifts of the lattices, in [0, 1) cells.
class Dither {
 public:
  explicit Dither(const Key& key);
  [[nodiscard]] double of(std::size_t functional, int rung) const {
    return shifts_[functional * kRungs + static_cast<std::size_t>(rung - kLeastRung)];
  }

 private:
  std::vector<double> shifts_;
};

// Where in its cell a mark brings each functional, besides the dither, in cells from 0 to 1: 0 or
// 1/2 for a bit.
using FluxPhases = std::array<double, kFunctionals>;

// The steps that marks may have: a reader tries all.
inline constexpr std::size_t kSteps = 14;

// Returns step `index`, 0.0015 * 2^(index / 4): in units of the normalised functionals.
[[nodiscard]] double step_size(std::size_t index);

// Sharpnesses at which a reader judges: for coarse, middling and fine readings.
inline constexpr std::array<double, 3> kSharpness = {1.5, 4, 14};

// Where in its cell a reader sees a functional, less the dither, in cells.
struct SoftPhase {
  double used = 0;     // the probability that a mark used the functional; 0: no information
  double nearest = 0;  // on its likely rung
  double other = 0;    // on the next likely
  double other_weight = 0;

  // Returns the logarithm of the likelihood, nats, that a mark brought the functional to a phase,
  // whose mean over all phases is one. `log_mean` is log_bessel(sharpness).
  [[nodiscard]] double log_likelihood(double phase, double sharpness, double log_mean) const;
};
using SoftPhases = std::array<SoftPhase, kFunctionals>;

// Returns log I0(x), the logarithm of the mean of exp(x cos) over a circle.
[[nodiscard]] double log_bessel(double x);

// Returns the phases at one step; `source` as for soft_bits(). O(1).
[[nodiscard]] SoftPhases soft_phases(const Measurement& measurement,
                                     std::span<const std::uint8_t, kFunctionals> source,
                                     const Dither& dither, double step);

// Soft values of all functionals under one hypothesis of what was done to the mesh.
struct SoftBits {
  // log-likelihood ratios, nats: positive for bit 0. 0: no information
  std::array<double, kFunctionals> ratio{};
  // the log of the likelihood of bit 1, whose mean without a mark is 1, nats
  std::array<double, kFunctionals> base{};

  // Returns the evidence for a word, in bits: minus the binary logarithm of a bound of the
  // probability that an unmarked mesh gives a word that was fixed before as good a reading.
  // bits[i] is the bit of functional i.
  [[nodiscard]] double evidence(std::span<const std::uint8_t> bits) const;

  // Returns the evidence for the likeliest bits, which no word exceeds.
  [[nodiscard]] double most_evidence() const;
};

// Returns the soft values at one step and sharpness. `source[i]` is the functional of the
// measurement that the mark would have called i. O(1).
[[nodiscard]] SoftBits soft_bits(const Measurement& measurement,
                                 std::span<const std::uint8_t, kFunctionals> source,
                                 const Dither& dither, double step, double sharpness);

}  // namespace triglyph
