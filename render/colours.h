// The colours of pictures: named ones and maps from numbers.
#pragma once

#include "render/image.h"

namespace triglyph {

// From the usual 8-bit code 0xrrggbb (sRGB) to linear light.
[[nodiscard]] Colour from_srgb(unsigned code);

// A share of full light, 0 .. 1, as stored in 8-bit files and shown by screens (IEC 61966-2-1), and
// back.
[[nodiscard]] float encode_srgb(float linear);
[[nodiscard]] float decode_srgb(float encoded);

inline constexpr unsigned kClay = 0xd8d3c9;      // a surface
inline constexpr unsigned kMarkBlue = 0x1f6fb4;  // what the mark moved
inline constexpr unsigned kBallGreen = 0x2c9e57;
inline constexpr unsigned kInk = 0x222222;

// For sizes: clay where nothing is, through yellow and red to a dark violet at 1. Darker always
// means more. `share` is held within 0 .. 1.
[[nodiscard]] Colour heat_colour(double share);

// For signed sizes, -1 .. 1: blue below, clay at nothing, red above.
[[nodiscard]] Colour signed_colour(double share);

}  // namespace triglyph
