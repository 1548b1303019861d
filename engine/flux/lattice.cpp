#include "engine/flux/lattice.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace triglyph {
namespace {

// The shares are in relation to the mean of so many functionals, whatever the number in use.
constexpr double kUsual = 64;

// Normalised functionals are displacements in units of the scale, averaged over the functional:
// about this is the area of a surface of radius one.
constexpr double kArea = 10;

// Width, in binary logarithms of the share, over which a reader doubts the rung: areas of a
// functional change by 2 % in what meshes go through.
constexpr double kRungDoubt = 0.03;

// Ratio of the share to the least share at which a functional is surely used.
constexpr double kUseDoubt = 1.08;

// A rung that a mark used with a lower probability is not weighed.
constexpr double kLeastOtherWeight = 1e-3;

}  // namespace

double log_bessel(double x) {
  return std::log(std::cyl_bessel_i(0.0, x));
}

double rung_unit(int rung) {
  return std::ldexp(kArea / kUsual, rung);
}

double Measured::other_value() const {
  return value * std::ldexp(1.0, rung - other_rung);
}

Measurement measured(const FluxValues& values) {
  const double total = std::accumulate(values.weight.begin(), values.weight.end(), 0.0);
  Measurement result;
  for (std::size_t i = 0; i < kFunctionals; ++i) {
    Measured& m = result[i];
    const double share = total > 0 ? values.weight[i] / total * kUsual : 0;
    const double doubt = std::log(share / kLeastShare) / std::log(kUseDoubt);
    m.used = std::clamp((doubt + 1) / 2, 0.0, 1.0);
    const double place = std::log2(std::max(share, kLeastShare));
    const double rung = std::round(place);
    const double offset = place - rung;
    m.rung = std::clamp(static_cast<int>(rung), kLeastRung, kLeastRung + int{kRungs} - 1);
    m.other_rung =
        std::clamp(m.rung + (offset < 0 ? -1 : 1), kLeastRung, kLeastRung + int{kRungs} - 1);
    m.other_weight =
        m.other_rung == m.rung ? 0 : 0.5 * std::exp((std::abs(offset) - 0.5) / kRungDoubt);
    m.value = values.flux[i] / rung_unit(m.rung);
  }
  return result;
}

Measurement with_fluxes(Measurement measurement, const FluxVector& fluxes) {
  for (std::size_t i = 0; i < kFunctionals; ++i) {
    measurement[i].value = fluxes[i] / rung_unit(measurement[i].rung);
  }
  return measurement;
}

Dither::Dither(const Key& key) {
  constexpr std::size_t kBytes = 4;
  const std::vector<std::uint8_t> bytes =
      key.stream(KeyUse::FluxDither, kBytes * kFunctionals * kRungs);
  for (std::size_t i = 0; i < bytes.size(); i += kBytes) {
    std::uint32_t number = 0;
    for (std::size_t b = 0; b < kBytes; ++b) number = number << 8 | bytes[i + b];
    shifts_.push_back(std::ldexp(static_cast<double>(number), -32));
  }
}

double step_size(std::size_t index) {
  return 0.0015 * std::exp2(static_cast<double>(index) / 4);
}

double SoftBits::evidence(std::span<const std::uint8_t> bits) const {
  double nats = 0;
  for (std::size_t i = 0; i < kFunctionals; ++i) {
    nats += base[i] + (bits[i] == 0 ? ratio[i] : 0);
  }
  return nats / M_LN2;
}

double SoftBits::most_evidence() const {
  double nats = 0;
  for (std::size_t i = 0; i < kFunctionals; ++i) nats += base[i] + std::max(ratio[i], 0.0);
  return nats / M_LN2;
}

double SoftPhase::log_likelihood(double phase, double sharpness, double log_mean) const {
  const auto component = [&](double place) {
    return std::exp(sharpness * std::cos(2 * M_PI * (place - phase)) - log_mean);
  };
  double likelihood = (1 - other_weight) * component(nearest);
  if (other_weight > 0) likelihood += other_weight * component(other);
  return std::log(1 - used + used * likelihood);
}

SoftPhases soft_phases(const Measurement& measurement,
                       std::span<const std::uint8_t, kFunctionals> source, const Dither& dither,
                       double step) {
  SoftPhases phases;
  for (std::size_t i = 0; i < kFunctionals; ++i) {
    const Measured& m = measurement[source[i]];
    if (!(m.used > 0) || !std::isfinite(m.value)) continue;
    SoftPhase& phase = phases[i];
    phase.used = m.used;
    phase.nearest = m.value / step - dither.of(i, m.rung);
    if (m.other_weight <= kLeastOtherWeight) continue;
    phase.other = m.other_value() / step - dither.of(i, m.other_rung);
    phase.other_weight = m.other_weight;
  }
  return phases;
}

SoftBits soft_bits(const Measurement& measurement,
                   std::span<const std::uint8_t, kFunctionals> source, const Dither& dither,
                   double step, double sharpness) {
  const double log_mean = log_bessel(sharpness);
  const SoftPhases phases = soft_phases(measurement, source, dither, step);
  SoftBits soft;
  for (std::size_t i = 0; i < kFunctionals; ++i) {
    if (phases[i].used == 0) continue;
    soft.base[i] = phases[i].log_likelihood(0.5, sharpness, log_mean);
    soft.ratio[i] = phases[i].log_likelihood(0, sharpness, log_mean) - soft.base[i];
  }
  return soft;
}

}  // namespace triglyph
