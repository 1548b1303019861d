// Text and picture files: the only user of OpenImageIO.
#pragma once

#include <filesystem>
#include <string>

#include "render/image.h"

namespace triglyph {

enum class TextAnchor { Left, Middle, Right };

// Writes one line into the picture, its anchor at x and the middle of its height at y; set smaller,
// down to 9 pixels, if it would be wider than `most_width`. Sizes in pixels. Throws Error
// Unreadable if there is no font.
struct TextStyle {
  int size = 20;
  int most_width = 1 << 20;
  TextAnchor anchor = TextAnchor::Middle;
};
void draw_text(const std::string& text, int x, int y, const TextStyle& style, Image& picture);

// Throws Error Unsupported unless the name ends in .png, .jpg, .jpeg or .exr.
void check_picture_name(const std::filesystem::path& path);

// PNG and JPEG with 8 bits a channel (sRGB; JPEG on white), EXR in linear light, 16-bit floats. The
// file appears whole or not at all. Throws Error Unsupported or Unwritable.
void write_picture(const Image& picture, const std::filesystem::path& path);

// Of a file that write_picture() wrote, for tests: linear light. Throws Error Unreadable.
[[nodiscard]] Image read_picture(const std::filesystem::path& path);

}  // namespace triglyph
