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

// Returns log I0(x), the log of the mean of exp(x cos) over a circle.
double log_bessel(double x) {
  return std::log(std::cyl_bessel_i(0.0, x));
}

}  // namespace

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

SoftBits soft_bits(const Measurement& measurement,
                   std::span<const std::uint8_t, kFunctionals> source, const Dither& dither,
                   double step, double sharpness) {
  const double spread = log_bessel(sharpness);
  SoftBits soft;
  for (std::size_t i = 0; i < kFunctionals; ++i) {
    const Measured& m = measurement[source[i]];
    if (!(m.used > 0) || !std::isfinite(m.value)) continue;
    // cosines of the phases under bit 0; bit 1 turns a phase by half a circle
    const auto cosine = [&](double value, int rung) {
      return std::cos(2 * M_PI * (value / step - dither.of(i, rung)));
    };
    const double nearest = cosine(m.value, m.rung);
    const double other = m.other_weight > 1e-3 ? cosine(m.other_value(), m.other_rung) : 0;
    const double other_weight = m.other_weight > 1e-3 ? m.other_weight : 0;
    // divided by the mean likelihood of each component, so that the whole has the mean 1
    const auto likelihood = [&](double sign) {
      return 1 - m.used +
             m.used * ((1 - other_weight) * std::exp(sign * sharpness * nearest - spread) +
                       other_weight * std::exp(sign * sharpness * other - spread));
    };
    soft.base[i] = std::log(likelihood(-1));
    soft.ratio[i] = std::log(likelihood(1)) - soft.base[i];
  }
  return soft;
}

}  // namespace triglyph
