// What marking answers.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "engine/message/words.h"
#include "engine/scheme/scheme.h"

namespace triglyph {

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
