// The options of IIE, and what applies unless the user says otherwise.
#pragma once

#include <array>
#include <string_view>

#include "engine/base/error.h"
#include "engine/message/words.h"
#include "engine/scheme/scheme_options.h"

namespace triglyph {

// How the bits of a word become shares of balls.
enum class IieEncoding {
  Global,  // generation 1 and fill: one radius for all balls; two shares each, see iie.h
  Local,   // a radius from the edges about each site; one share each, whitened, see local_iie.h
};

// The names by IieEncoding.
inline constexpr std::array<std::string_view, 2> kIieEncodingNames = {"global", "local"};

struct IieOptions : SchemeOptions {
  IieEncoding encoding = IieEncoding::Global;
  // The radius of the balls in mean edge lengths, of the mesh or about the site; or, if `radius` >
  // 0, that in model units.
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
    options.step = 1.25e-4;
    if (fill) return options;
    options.encoding = IieEncoding::Local;
    options.step = 0.0028;
    options.radius_edges = 2.8;
    options.site_rings = 7;
    return options;
  }
  [[nodiscard]] static WordFormat format(bool fill) {
    return fill ? WordFormat{1, 9, 6} : WordFormat{0, 10, 3, true};
  }
  // Wider cells survive more noise.
  [[nodiscard]] static IieOptions strong() {
    IieOptions options = defaults(false);
    options.step = 0.004;
    return options;
  }
  static constexpr WordFormat kStrongFormat{0, 10, 3, true};
  // What messages of generation 1 used.
  [[nodiscard]] static IieOptions first_generation() {
    IieOptions options;
    options.step = 0.007;
    options.radius_edges = 3.8;
    options.site_rings = 4;
    options.doubtful_parts = 10;
    return options;
  }
  static constexpr WordFormat kFirstFormat{0, 5, 4};
  static constexpr bool kHasFewUnits = true;

  // Throws Error Usage for a step, radius or number of rings out of range.
  void check() const {
    const auto refuse = [](const char* what) { throw Error(ErrorCode::Usage, {}, "", what); };
    if (!(step > 0 && step <= 0.25)) refuse("the cell width of iie lies above 0 and up to 0.25");
    if (!(radius_edges >= 2 && radius_edges <= 100)) {
      refuse("the radius of iie is 2 to 100 mean edges");
    }
    if (centre_rings < 1 || centre_rings > 3) {
      refuse("the centres of iie are means over 1 to 3 rings");
    }
    if (!(radius >= 0) || site_rings < 0 || site_rings > 8) {
      refuse("iie wants a radius of at least 0 and 0 to 8 rings between sites");
    }
  }

  [[nodiscard]] static OptionTable<IieOptions> table() {
    using Own = IieOptions;
    return {
        step_option<Own>(0.25),
        choice_option<Own>("iie_encoding", &Own::encoding, kIieEncodingNames, "the scheme's",
                           "How iie puts bits into balls; global is that of the first generation "
                           "and of --fill"),
        number_option<Own>("radius_edges", &Own::radius_edges, {2, 100}, "mean edge lengths",
                           "the scheme's", "Radius of the balls of iie"),
        number_option<Own>("radius", &Own::radius, {0}, "model units", "0",
                           "Radius of the balls of iie instead; then scaling is not survived; 0: "
                           "by the mean edge length"),
        count_option<Own>("site_rings", &Own::site_rings, {0, 8}, "rings", "the scheme's",
                          "Distance within which one point may be a centre of iie; 0: any point"),
        count_option<Own>("centre_rings", &Own::centre_rings, {1, 3}, "rings", "the scheme's",
                          "Rings of points whose mean is a centre of iie"),
        count_option<Own>("doubtful_parts", &Own::doubtful_parts, {0, 16}, "parts", "the scheme's",
                          "Parts whose second best value is tried when iie is read; each doubles "
                          "the chance of a false alarm")};
  }
};

}  // namespace triglyph
