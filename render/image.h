// Images in memory: linear light, premultiplied alpha, rows from the top.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace triglyph {

struct Colour {
  float red = 0, green = 0, blue = 0, alpha = 1;
};

// Returns `top` composited over `below`, both premultiplied.
[[nodiscard]] inline Colour over(const Colour& top, const Colour& below) {
  const float rest = 1 - top.alpha;
  return {top.red + rest * below.red, top.green + rest * below.green, top.blue + rest * below.blue,
          top.alpha + rest * below.alpha};
}

// Interpolates linearly from a (share 0) to b (share 1).
[[nodiscard]] inline Colour mix(const Colour& a, const Colour& b, float share) {
  return {a.red + share * (b.red - a.red), a.green + share * (b.green - a.green),
          a.blue + share * (b.blue - a.blue), a.alpha + share * (b.alpha - a.alpha)};
}

// Returns all four channels scaled by a factor, which makes an opaque colour translucent.
[[nodiscard]] inline Colour times(const Colour& colour, float factor) {
  return {colour.red * factor, colour.green * factor, colour.blue * factor, colour.alpha * factor};
}

class Image {
 public:
  Image(int width, int height, const Colour& fill = {0, 0, 0, 0})
      : width_(width),
        height_(height),
        pixels_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), fill) {}

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] Colour& at(int x, int y) { return pixels_[index(x, y)]; }
  [[nodiscard]] const Colour& at(int x, int y) const { return pixels_[index(x, y)]; }
  [[nodiscard]] std::span<Colour> pixels() { return pixels_; }
  [[nodiscard]] std::span<const Colour> pixels() const { return pixels_; }

 private:
  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(x);
  }

  int width_;
  int height_;
  std::vector<Colour> pixels_;
};

// Composites `part` over the picture with its upper left corner at (left, top), clipped to the
// picture.
void paste(const Image& part, int left, int top, Image& picture);

// Fills a rectangle, clipped to the picture.
void fill_rectangle(int left, int top, int width, int height, const Colour& colour, Image& picture);

}  // namespace triglyph
