// What marking is told and what it answers; mark.h puts the one into the other.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/layout/layout.h"
#include "engine/message/words.h"
#include "engine/scheme/scheme.h"

namespace triglyph {

enum class AssignMethod {
  Sequential,  // un-optimised: the i-th unit carries the i-th word
  Bottleneck,  // least maximum of the costs, and of those the least sum (the paper's eq. 3)
  Sum,         // least sum of the costs (eq. 2)
};

// "sequential", "bottleneck", "sum"; the inverse throws Error Usage.
[[nodiscard]] std::string_view name_of(AssignMethod method);
[[nodiscard]] AssignMethod assign_method(const std::string& name);

struct MarkOptions {
  std::string scheme = "tsq";
  WordFormat format;
  SchemeOptions scheme_options;
  ConflictRule conflict_rule = ConflictRule::ReadWrite;
  LayoutOptions layout;
  AssignMethod assign = AssignMethod::Bottleneck;
  std::uint32_t redundancy = 32;  // wanted units a part; 0: as many as there are
  // A unit that would move a point farther than this share of the bounding box's diagonal is used
  // only if its part has fewer than kMinRedundancy others, and never if it is ten times as far.
  // 0: no limit. Not for sequential or fill.
  double max_move_rel_diag = 0.001;
  // This share of the candidates, 0 up to 1, is left out: those whose cheapest word costs most.
  // Less capacity, and a less visible mark, since a unit that is dear under every word is a floor
  // of the bottleneck that no assignment gets below (TSQ: the marker's own cost).
  double drop_dearest = 0;
  // Fill uses format.subscript_bits as they are, instead of as few as tell the units apart.
  bool keeps_subscript_bits = false;
};

// The options with which a scheme marks a message or fills a mesh unless the user says otherwise.
// Throws Error Usage for an unknown scheme.
[[nodiscard]] MarkOptions default_mark_options(const std::string& scheme, bool fill);

enum class MarkStatus {
  Marked,
  TooSmall,   // some part found no unit that can carry it
  TooCoarse,  // the file's numbers are too coarse to hold the cells
};

// A unit that carries a word after rounding and settling.
struct Carrier {
  std::uint32_t anchor = 0;
  std::uint32_t word = 0;  // index into Marking::words

  bool operator==(const Carrier&) const = default;
};

struct Marking {
  MarkStatus status = MarkStatus::Marked;
  std::vector<Vec3> positions;  // of all points, as the file will hold them
  std::vector<Word> words;      // one a part
  WordFormat format;            // of the words; --fill chooses the subscript bits
  std::vector<Carrier> carriers;
  std::uint32_t parts_carried = 0;  // parts with at least one carrier
  std::uint32_t candidates = 0;
  std::uint32_t units_valid = 0;     // after layout
  std::uint32_t units_bound = 0;     // no layout has more
  std::uint32_t units_assigned = 0;  // given a word they can carry
  std::uint32_t units_dropped = 0;   // taken back: rounding or a flipped face spoiled them
  double cost_max = 0;               // of the assignment, model units
  double cost_sum = 0;
  double layout_seconds = 0;  // step 1: candidates, conflicts, layout
  double assign_seconds = 0;  // step 2: costs and assignment, all rounds
};

// The nearest point that the output can hold.
using Rounding = std::function<Vec3(const Vec3&)>;

}  // namespace triglyph
