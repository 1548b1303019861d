// The result of marking.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "engine/base/options.h"
#include "engine/flux/flux_mark.h"
#include "engine/message/words.h"
#include "engine/scheme/scheme.h"

namespace triglyph {

enum class MarkStatus {
  Marked,
  TooSmall,       // fewer units than parts, or a part without a unit that can carry it
  TooCoarse,      // the numbers of the file are too far apart for the quantiser cells
  AlreadyMarked,  // the mesh carries a mark of this key already, see Marking::found
  TooVisible,  // some part has no unit that can carry it within MarkOptions::max_move_percent, or
               // the mark exceeds MarkOptions::max_visibility
  NoFlux,      // the shape carries no flux mark, see Marking::flux_obstacle
};

// A unit that carries a word after rounding and settling.
struct Carrier {
  std::uint32_t anchor = 0;
  std::uint32_t word = 0;  // index into Marking::words

  bool operator==(const Carrier&) const = default;
};

// What would help a mesh that is refused. Each was tried on the mesh with success; 0 where nothing
// was found, or not looked for.
struct WayOut {
  std::size_t message_bytes = 0;          // the longest beginning of the message that fits
  std::uint32_t least_parts_carried = 0;  // of the shortest beginning that was tried, if none fits
  double move_needed_percent = 0;         // the least move that some part needs
  double max_move_percent = 0;            // the least limit of moves that does
  double step = 0;                        // the width of cells that does
};

// A mark that a mesh carries.
struct FoundMessage {
  Message message;             // empty: see flux
  std::uint32_t agreeing = 0;  // units whose word is exactly that of the message
  std::optional<FluxFound> flux;
};

struct Marking {
  MarkStatus status = MarkStatus::Marked;
  bool is_fingerprint = false;      // of the message, in place of the message itself
  bool needs_original = false;      // to find the fingerprint, which displaces every point
  std::vector<Vec3> positions;      // of all points, as the file will hold them
  std::vector<Word> words;          // one per part, and of a message others with parities
  WordFormat format;                // of the words; fill chooses the subscript bits
  OptionValues scheme_options;      // of the units, if not those that were asked for
  std::vector<Carrier> carriers;    // ascending by anchor
  std::uint32_t parts_carried = 0;  // with at least one carrier, of those needed or of fill's
  std::uint32_t parts_needed = 0;   // the first words, which a message needs; 0: fill
  bool is_readable = true;          // a spread message: is it found among all votes?
  std::uint32_t candidates = 0;
  std::uint32_t units_valid = 0;      // chosen by the layout
  std::uint32_t units_bound = 0;      // upper bound of the size of any layout
  std::uint32_t units_assigned = 0;   // given a word that they can carry
  std::uint32_t units_dropped = 0;    // restored, because of rounding or a flipped face
  double cost_max = 0;                // of the assignment, model units
  double cost_sum = 0;                // likewise
  double layout_seconds = 0;          // step 1: candidates, conflicts, layout
  double assign_seconds = 0;          // step 2: costs and assignment, all rounds
  std::optional<FoundMessage> found;  // only of a mesh that is already marked
  WayOut way_out;                     // unless marked
  int colluders = 1;                  // that a fingerprint resists: see colluders_resisted()
  double expected_bits = 0;           // of evidence that a fingerprint can leave
  double visibility = 0;              // MSDM2 of the whole mark, if it is limited
  std::optional<FluxMark> flux;       // the flux layer
  FluxObstacle flux_obstacle = FluxObstacle::None;  // why there is none, if it was wanted
};

// Returns the nearest point that the output can represent.
using Rounding = std::function<Vec3(const Vec3&)>;

// Returns the triangles into which a reader of the output cuts its faces if the points lie there:
// as many as the marked surface has, in the same order. Empty: always those of the surface.
using Recut = std::function<std::vector<Triangle>(std::span<const Vec3> positions)>;

}  // namespace triglyph
