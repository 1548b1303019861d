// Arrangement of pictures side by side, with titles, notes and colour bars.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "render/image.h"

namespace triglyph {

// The scale of a heat map: 0 .. greatest, or -greatest .. greatest if signed.
struct Scale {
  double greatest = 0;
  bool is_signed = false;
};

struct Panel {
  std::string title;
  std::string note;  // below the picture, instead of a scale
  Image image;
  std::optional<Scale> scale;
};

// Returns the number of columns: up to 3 panels stand in one row, 4 as 2 x 2, more in rows of 3.
[[nodiscard]] int columns_of(std::size_t panels);

// Returns a number with three digits for labels ("0.0387", "1.2e-07").
[[nodiscard]] std::string short_number(double value);

// Draws the panels in cells as large as the largest of them. Precondition: at least one panel.
[[nodiscard]] Image arrange(const std::vector<Panel>& panels, const Colour& background);

}  // namespace triglyph
