#include "engine/flux/evidence.h"

#include <algorithm>
#include <cmath>

namespace triglyph {
namespace {

// The largest exponent that is tried: I_0 of larger ones overflows.
constexpr double kMostExponent = 600;

}  // namespace

double cosine_evidence(double sum, std::size_t count) {
  if (!(sum > 0)) return 0;
  const auto nats = [&](double exponent) {
    return exponent * sum - static_cast<double>(count) * std::log(std::cyl_bessel_i(0.0, exponent));
  };
  // concave in the exponent
  double low = 0;
  double high = kMostExponent;
  for (int i = 0; i < 60; ++i) {
    const double a = low + (high - low) / 3;
    const double b = high - (high - low) / 3;
    (nats(a) < nats(b) ? low : high) = nats(a) < nats(b) ? a : b;
  }
  return std::max(0.0, nats(low)) / M_LN2;
}

}  // namespace triglyph
