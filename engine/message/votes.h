// Repeats of a part, found in different places of a mesh, vote for its bits. A genuine unit sits at
// the centres of its cells while chance look-alikes are spread evenly over them, so a vote weighs
// more the nearer the invariants are to the centres.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/message/words.h"

namespace triglyph {

// One unit whose marker was found in a mesh.
struct Reading {
  std::uint32_t anchor = 0;             // the unit's anchor in the mesh that was read
  Word word;                            // the bits that stand there
  float weight = 0;                     // product of the closeness of all its invariants, 0..1
  float worst_offset = 0;               // farthest from a cell centre; 1 is the cell's border
  std::array<float, 32> bit_weights{};  // closeness of the invariant that holds each part bit
};

class Votes {
 public:
  explicit Votes(const WordCode& code);

  void add(const Reading& reading);

  // The part of each index below 2^s; nothing where no unit voted.
  [[nodiscard]] std::vector<std::optional<std::uint32_t>> parts() const;

  // Agreement of the votes on one part, 0 (tied or none) to 1 (of one mind): the least over its
  // bits of |for - against| / (for + against).
  [[nodiscard]] double agreement(std::uint32_t part_index) const;

 private:
  struct Bit {
    double set = 0;
    double clear = 0;
  };
  const WordCode* code_;
  std::vector<Bit> bits_;  // part_bits a part
  std::vector<std::uint32_t> voters_;
};

}  // namespace triglyph
