#include "render/panels.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "engine/base/error.h"
#include "render/colours.h"
#include "render/picture_file.h"

namespace triglyph {
namespace {

constexpr int kMarginPixels = 14;
constexpr int kTitleHeight = 34;
constexpr int kTitleSize = 22;
constexpr int kNoteSize = 17;
constexpr int kNoteHeight = 50;
constexpr int kBarHeight = 14;

// Draws a colour bar from left to right, with numbers at its ends and in its middle.
void draw_scale(const Scale& scale, int left, int top, int width, Image& picture) {
  const int bar_width = width * 3 / 4;
  const int bar_left = left + (width - bar_width) / 2;
  for (int x = 0; x < bar_width; ++x) {
    const double share = (x + 0.5) / bar_width;
    const Colour colour = scale.is_signed ? signed_colour(2 * share - 1) : heat_colour(share);
    fill_rectangle(bar_left + x, top + 4, 1, kBarHeight, colour, picture);
  }
  const double least = scale.is_signed ? -scale.greatest : 0;
  const int y = top + 4 + kBarHeight + 14;
  const TextStyle style{kNoteSize, width / 4, TextAnchor::Middle};
  draw_text(short_number(least), bar_left, y, style, picture);
  draw_text(short_number((least + scale.greatest) / 2), bar_left + bar_width / 2, y, style,
            picture);
  draw_text(short_number(scale.greatest), bar_left + bar_width, y, style, picture);
}

}  // namespace

int columns_of(std::size_t panels) {
  if (panels <= 3) return static_cast<int>(std::max<std::size_t>(1, panels));
  return panels == 4 ? 2 : 3;
}

std::string short_number(double value) {
  if (value == 0) return "0";
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

Image arrange(const std::vector<Panel>& panels, const Colour& background) {
  check(!panels.empty(), "a picture has panels");
  int width = 0;
  int height = 0;
  for (const Panel& panel : panels) {
    width = std::max(width, panel.image.width());
    height = std::max(height, panel.image.height());
  }
  const int columns = columns_of(panels.size());
  const int rows = (static_cast<int>(panels.size()) + columns - 1) / columns;
  const int cell_width = width + kMarginPixels;
  const int cell_height = kTitleHeight + height + kNoteHeight;
  Image picture(columns * cell_width + kMarginPixels, rows * cell_height + kMarginPixels,
                background);
  for (std::size_t i = 0; i < panels.size(); ++i) {
    const Panel& panel = panels[i];
    const int left = kMarginPixels + static_cast<int>(i) % columns * cell_width;
    const int top = kMarginPixels + static_cast<int>(i) / columns * cell_height;
    const int middle = left + width / 2;
    draw_text(panel.title, middle, top + kTitleHeight / 2, {kTitleSize, width, TextAnchor::Middle},
              picture);
    paste(panel.image, left + (width - panel.image.width()) / 2,
          top + kTitleHeight + (height - panel.image.height()) / 2, picture);
    const int below = top + kTitleHeight + height;
    if (panel.scale) {
      draw_scale(*panel.scale, left, below, width, picture);
    } else if (!panel.note.empty()) {
      draw_text(panel.note, middle, below + kNoteHeight / 3, {kNoteSize, width, TextAnchor::Middle},
                picture);
    }
  }
  return picture;
}

}  // namespace triglyph
