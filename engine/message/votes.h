// Repeats of a part, found in different places of a mesh, vote for its value. A genuine unit sits
// at the centres of its cells while chance look-alikes are spread evenly over them, so a vote
// weighs more the nearer the invariants are to the centres. Look-alikes seldom agree on a whole
// value, so values are voted on, not single bits; a value that differs in a bit or two still gets a
// little.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
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
  // What stands for one part, best first: values and their scores. Empty without votes.
  struct Choice {
    std::uint32_t part = 0;
    double score = 0;
  };
  using Ranking = std::vector<Choice>;

  explicit Votes(const WordCode& code);

  void add(const Reading& reading);

  // For each index below 2^s at most kRanked values. Parallel.
  // O(readings * kMostValues) at most.
  [[nodiscard]] std::vector<Ranking> rankings() const;

  // The best value of each; nothing where no unit voted.
  [[nodiscard]] std::vector<std::optional<std::uint32_t>> parts() const;

  // Agreement of the votes on one part, 0 (tied or none) to 1 (of one mind): the least over its
  // bits of |for - against| / (for + against).
  [[nodiscard]] double agreement(std::uint32_t part_index) const;

  static constexpr std::size_t kRanked = 2;
  static constexpr std::size_t kMostValues = 64;  // the heaviest; others are not considered

 private:
  struct Bit {
    double set = 0;
    double clear = 0;
  };
  struct Vote {
    std::uint32_t part = 0;
    float weight = 0;
    std::array<float, 32> bit_weights{};
  };
  [[nodiscard]] Ranking rank(const std::vector<Vote>& votes) const;

  const WordCode* code_;
  std::vector<Bit> bits_;  // part_bits a part
  std::vector<std::vector<Vote>> votes_;
};

}  // namespace triglyph
