// Pictures side by side, with titles, notes and colour bars.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "render/image.h"

namespace triglyph {

// What the colours of a heat map mean: 0 .. greatest, or -greatest .. greatest if signed.
struct Scale {
  double greatest = 0;
  bool is_signed = false;
};

struct Panel {
  std::string title;
  std::string note;  // below the picture, if there is no scale
  Image image;
  std::optional<Scale> scale;
};

// How many columns so many panels stand in: 1, 2, 3 in a row, 4 as 2 x 2, more in rows of 3.
[[nodiscard]] int columns_of(std::size_t panels);

// "0.0387", "1.2e-07": three digits, as labels show numbers.
[[nodiscard]] std::string short_number(double value);

// Precondition: at least one panel. Cells are as large as the largest panel.
[[nodiscard]] Image arrange(const std::vector<Panel>& panels, const Colour& background);

}  // namespace triglyph
