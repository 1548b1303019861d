// The options of IIE, and what applies unless the user says otherwise.
#pragma once

#include "engine/message/words.h"
#include "engine/scheme/scheme_options.h"

namespace triglyph {

struct IieOptions : SchemeOptions {
  // The radius of the balls in mean edge lengths of the mesh; or, if `radius` > 0, that in model
  // units.
  double radius_edges = 3.5;
  double radius = 0;
  // Anchors are points whose connectivity beats that of all points within so many rings; 0: any
  // point.
  int site_rings = 0;
  // A ball's centre is the mean of the points within so many rings of its anchor.
  int centre_rings = 1;
  // The number of parts whose second best value extraction tries if the best ones make no message.
  int doubtful_parts = 0;

  // A message's cells survive noise of 0.1 %; with fill they need only survive rounding.
  [[nodiscard]] static IieOptions defaults(bool fill) {
    IieOptions options;
    options.step = fill ? 1.25e-4 : 0.007;
    if (fill) return options;
    options.radius_edges = 3.8;
    options.site_rings = 4;
    options.doubtful_parts = 10;
    return options;
  }
  [[nodiscard]] static WordFormat format(bool fill) {
    return fill ? WordFormat{1, 9, 6} : WordFormat{0, 5, 4};
  }
  static constexpr bool kHasFewUnits = true;

  [[nodiscard]] static OptionTable<IieOptions> table() {
    using Own = IieOptions;
    return {
        step_option<Own>(0.25),
        number_option<Own>("radius_edges", &Own::radius_edges, {2, 100}, "mean edge lengths",
                           "the scheme's", "Radius of the balls of iie"),
        number_option<Own>("radius", &Own::radius, {0}, "model units", "0",
                           "Radius of the balls of iie instead; then scaling is not survived; 0: "
                           "by the mean edge length"),
        count_option<Own>("site_rings", &Own::site_rings, {0, 8}, "rings", "the scheme's",
                          "Distance within which one point may be a centre of iie; 0: any point"),
        count_option<Own>("centre_rings", &Own::centre_rings, {1, 3}, "rings", "1",
                          "Rings of points whose mean is a centre of iie"),
        count_option<Own>("doubtful_parts", &Own::doubtful_parts, {0, 16}, "parts", "the scheme's",
                          "Parts whose second best value is tried when iie is read; each doubles "
                          "the chance of a false alarm")};
  }
};

}  // namespace triglyph
