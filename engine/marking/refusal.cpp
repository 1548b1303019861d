#include "engine/marking/refusal.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "engine/marking/copies.h"
#include "engine/marking/way_out.h"

namespace triglyph {
namespace {

// Returns a number with three significant digits, for the eye.
std::string short_text(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.3g", value);
  return text;
}

std::string count_of(std::size_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

std::string carries_mark(const FoundMessage& found) {
  if (found.flux) {
    return "carries " + shown(found.flux->payload) +
           " in its flux layer under this key already; --remark marks it again";
  }
  return "carries " + shown(found.message) + " under this key already (" +
         count_of(found.agreeing, "unit") + (found.agreeing == 1 ? " agrees" : " agree") +
         "); --remark marks it again";
}

// Says what the mesh lacks for a message of one byte.
std::string carries_nothing(const Marking& marking, const MarkOptions& options) {
  const std::uint32_t needed = least_units_for(options.format, 1);
  const std::string text = "this mesh carries no message of any length under " + options.scheme;
  if (marking.units_valid < needed) {
    return text + ": it has " + count_of(marking.units_valid, "unit") +
           ", a message of 1 byte needs " + std::to_string(needed);
  }
  const std::uint32_t carried =
      marking.parts_needed == needed ? marking.parts_carried : marking.way_out.least_parts_carried;
  return text + ": its " + count_of(marking.units_valid, "unit") + " carry " +
         std::to_string(carried) + " of the " + std::to_string(needed) +
         " parts of a message of 1 byte";
}

std::string too_small_for_message(const Marking& marking, const MarkRequest& request) {
  const WayOut& way_out = marking.way_out;
  const std::string needs = count_of(marking.parts_needed, "part") + " needed, ";
  const std::string farther =
      way_out.max_move_percent > 0
          ? "allow moves that may be seen with --max-move " + to_text(way_out.max_move_percent)
          : "";
  if (way_out.message_bytes > 0) {
    const std::uint32_t fit = least_units_for(request.options.format, way_out.message_bytes);
    return needs + std::to_string(fit) + " fit: shorten the message by " +
           count_of(request.message().size() - way_out.message_bytes, "byte") +
           (farther.empty() ? "" : ", or " + farther);
  }
  if (!farther.empty()) {
    return needs + std::to_string(marking.parts_carried) + " carried: " + farther;
  }
  return carries_nothing(marking, request.options);
}

std::string too_small_for_fill(const Marking& marking, const MarkOptions& options) {
  if (marking.units_valid == 0) return "this mesh has no unit under " + options.scheme;
  return "none of this mesh's " + count_of(marking.units_valid, "unit") + " under " +
         options.scheme + " can carry a part";
}

std::string too_visible(const Marking& marking) {
  if (marking.visibility > 0) {
    return "the mark would have an MSDM2 of " + short_text(marking.visibility) +
           "; --max-visibility " + to_text(rounded_up(marking.visibility)) + " would do";
  }
  const WayOut& way_out = marking.way_out;
  return "some part needs a move of " + short_text(way_out.move_needed_percent) +
         " % of the diagonal; --max-move " + to_text(way_out.max_move_percent) + " would do";
}

// Says why the flux layer is not possible, and what is.
std::string no_flux(FluxObstacle obstacle) {
  const std::string otherwise = "; --scheme tsq reads single triangles instead";
  switch (obstacle) {
    case FluxObstacle::NoVolume:
      return "the mesh encloses no volume, which a flux mark needs" + otherwise;
    case FluxObstacle::NoAxes:
      return "two principal axes of the mesh are equal, as in a ball or a cube, so that a reader "
             "of "
             "flux would not know which is which" +
             otherwise;
    case FluxObstacle::TooNarrow:
      return "the surface lies at too few distances from its centre for a flux mark" + otherwise;
    case FluxObstacle::TooFaint:
      return "a flux mark this faint would not be found again: the mesh is too coarse, or needs "
             "--strength strong" +
             otherwise;
    case FluxObstacle::TooVisible:
      return "a flux mark within the limits of moves and visibility would not be found again" +
             otherwise;
    case FluxObstacle::None:
      break;
  }
  return "the mesh carries no flux mark";
}

std::string too_coarse(const WayOut& way_out, double number_step) {
  const std::string wider =
      way_out.step > 0 ? ", or mark it with --step " + to_text(way_out.step) : "";
  return "numbers " + short_text(number_step) +
         " apart are too coarse for the mark: export the mesh with more digits or as float64" +
         wider;
}

// Returns a number of bytes for the eye, in decimal units.
std::string size_of(std::uint64_t bytes) {
  const auto size = static_cast<double>(bytes);
  return size < 999.5e6 ? short_text(size / 1e6) + " MB" : short_text(size / 1e9) + " GB";
}

}  // namespace

std::string refusal(const Marking& marking, const MarkRequest& request, double number_step) {
  switch (marking.status) {
    case MarkStatus::TooSmall:
      if (marking.is_fingerprint) return too_little_evidence(marking.expected_bits, kTraceable);
      return request.is_fill() ? too_small_for_fill(marking, request.options)
                               : too_small_for_message(marking, request);
    case MarkStatus::AlreadyMarked:
      return carries_mark(*marking.found);
    case MarkStatus::TooVisible:
      return too_visible(marking);
    case MarkStatus::TooCoarse:
      return too_coarse(marking.way_out, number_step);
    case MarkStatus::NoFlux:
      return no_flux(marking.flux_obstacle);
    case MarkStatus::Marked:
      break;
  }
  return "";
}

std::string not_read_back(std::uint32_t found, std::uint32_t units, bool triangles_would_do) {
  return "the mark could not be read back (" + std::to_string(found) + " of " +
         count_of(units, "unit") + "): " +
         (triangles_would_do ? "its polygons are cut into other triangles once points have moved; "
                               "export the mesh as triangles, from which the mark can be read"
                             : "try another --scheme");
}

std::string too_little_evidence(double bits, double needed) {
  return "a fingerprint in this mesh leaves " + short_text(std::max(0.0, std::floor(bits))) +
         " bits of evidence, " + short_text(needed) +
         " are needed to name one of a thousand: it has too few points";
}

// No mesh is estimated at less than a mebibyte, so that this budget has room for one at a time.
std::string too_little_memory(std::uint64_t estimate) {
  return "not enough memory: this mesh takes about " + size_of(estimate) +
         "; with --memory 1M no other is in process at the same time";
}

}  // namespace triglyph
