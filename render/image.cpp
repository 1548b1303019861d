#include "render/image.h"

#include <algorithm>

namespace triglyph {

void paste(const Image& part, int left, int top, Image& picture) {
  for (int y = std::max(0, -top); y < std::min(part.height(), picture.height() - top); ++y) {
    for (int x = std::max(0, -left); x < std::min(part.width(), picture.width() - left); ++x) {
      Colour& pixel = picture.at(left + x, top + y);
      pixel = over(part.at(x, y), pixel);
    }
  }
}

void fill_rectangle(int left, int top, int width, int height, const Colour& colour,
                    Image& picture) {
  for (int y = std::max(0, top); y < std::min(top + height, picture.height()); ++y) {
    for (int x = std::max(0, left); x < std::min(left + width, picture.width()); ++x) {
      picture.at(x, y) = over(colour, picture.at(x, y));
    }
  }
}

}  // namespace triglyph
