// Colours of pictures, and maps from numbers to colours.
#pragma once

#include "render/image.h"

namespace triglyph {

// Converts a code 0xrrggbb (8-bit sRGB) to linear light.
[[nodiscard]] Colour from_srgb(unsigned code);

// Convert linear light, 0 to 1, to the sRGB encoding (IEC 61966-2-1) and back.
[[nodiscard]] float encode_srgb(float linear);
[[nodiscard]] float decode_srgb(float encoded);

inline constexpr unsigned kClay = 0xd8d3c9;       // surfaces
inline constexpr unsigned kMarkBlue = 0x1f6fb4;   // points and facets that the mark moved
inline constexpr unsigned kBallGreen = 0x2c9e57;  // balls of iie
inline constexpr unsigned kInk = 0x222222;        // text and edges

// Returns the colour of a magnitude: clay at 0, through yellow and red to dark violet at 1, getting
// darker throughout. `share` is clamped to 0 .. 1.
[[nodiscard]] Colour heat_colour(double share);

// Returns the colour of a signed magnitude, -1 to 1: blue if negative, clay at 0, red if positive.
[[nodiscard]] Colour signed_colour(double share);

}  // namespace triglyph
