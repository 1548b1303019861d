// Picture files and text in pictures. The only user of OpenImageIO.
#pragma once

#include <filesystem>
#include <string>

#include "render/image.h"

namespace triglyph {

enum class TextAnchor { Left, Middle, Right };

// Sizes in pixels.
struct TextStyle {
  int size = 20;
  int most_width = 1 << 20;  // a wider text is set smaller, down to 9 pixels
  TextAnchor anchor = TextAnchor::Middle;
};

// Draws one line of text with its anchor at x and the middle of its height at y. Throws Error
// Unreadable if no font is installed.
void draw_text(const std::string& text, int x, int y, const TextStyle& style, Image& picture);

// Throws Error Unsupported unless the name ends in .png, .jpg, .jpeg or .exr.
void check_picture_name(const std::filesystem::path& path);

// Writes PNG or JPEG with 8 bits per channel (sRGB; JPEG on white), or EXR with 16-bit floats in
// linear light. The file appears complete or not at all. Throws Error Unsupported or Unwritable.
void write_picture(const Image& picture, const std::filesystem::path& path);

// Reads a file that write_picture() wrote, in linear light; for tests. Throws Error Unreadable.
[[nodiscard]] Image read_picture(const std::filesystem::path& path);

}  // namespace triglyph
