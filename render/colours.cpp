#include "render/colours.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace triglyph {
namespace {

struct Stop {
  double share;
  unsigned code;
};

// Interpolates linearly between stops, which ascend from 0 to 1.
Colour along(std::span<const Stop> stops, double share) {
  std::size_t next = 1;
  while (next + 1 < stops.size() && stops[next].share < share) ++next;
  const Stop& low = stops[next - 1];
  const Stop& high = stops[next];
  const double part = std::clamp((share - low.share) / (high.share - low.share), 0.0, 1.0);
  return mix(from_srgb(low.code), from_srgb(high.code), static_cast<float>(part));
}

}  // namespace

float encode_srgb(float linear) {
  const float held = std::clamp(linear, 0.0F, 1.0F);
  return held <= 0.0031308F ? 12.92F * held : 1.055F * std::pow(held, 1 / 2.4F) - 0.055F;
}

float decode_srgb(float encoded) {
  return encoded <= 0.04045F ? encoded / 12.92F : std::pow((encoded + 0.055F) / 1.055F, 2.4F);
}

Colour from_srgb(unsigned code) {
  const auto channel = [&](unsigned shift) {
    return decode_srgb(static_cast<float>((code >> shift) & 0xff) / 255.0F);
  };
  return {channel(16), channel(8), channel(0), 1};
}

Colour heat_colour(double share) {
  static constexpr std::array<Stop, 5> kStops = {
      {{0, kClay}, {0.08, 0xf5d63d}, {0.35, 0xec7a1c}, {0.65, 0xb3243a}, {1, 0x3a0a4f}}};
  return along(kStops, share);
}

Colour signed_colour(double share) {
  static constexpr std::array<Stop, 7> kStops = {{{0, 0x0c2a5e},
                                                  {0.25, 0x2f7cc4},
                                                  {0.46, 0x8fc3ea},
                                                  {0.5, kClay},
                                                  {0.54, 0xf0a878},
                                                  {0.75, 0xd4502e},
                                                  {1, 0x70101c}}};
  return along(kStops, (share + 1) / 2);
}

}  // namespace triglyph
