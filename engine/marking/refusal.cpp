#include "engine/marking/refusal.h"

#include <cstdio>

namespace triglyph {
namespace {

// Returns a number with three significant digits, for the eye.
std::string short_text(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.3g", value);
  return text;
}

std::string too_small(const Marking& marking) {
  return std::to_string(marking.units_valid) + " units carry " +
         std::to_string(marking.parts_carried) + " of the message's " +
         std::to_string(marking.words.size()) + " parts";
}

std::string too_visible(const WayOut& way_out) {
  return "some part needs a move of " + short_text(way_out.move_needed_percent) +
         " % of the diagonal; --max-move " + to_text(way_out.max_move_percent) + " would do";
}

}  // namespace

std::string refusal(const Marking& marking, const MarkRequest& /*request*/, double number_step) {
  switch (marking.status) {
    case MarkStatus::TooSmall:
      return too_small(marking);
    case MarkStatus::TooVisible:
      return too_visible(marking.way_out);
    case MarkStatus::TooCoarse:
      return "numbers " + short_text(number_step) + " apart are too coarse for the mark";
    case MarkStatus::Marked:
      break;
  }
  return "";
}

}  // namespace triglyph
