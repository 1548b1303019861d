// Voting on the values of parts. Copies of a part, read from different units, vote for its value.
// The invariants of a genuine unit lie at the centres of their quantiser cells, whereas those of a
// false positive are spread evenly over them, so a vote weighs more the closer its invariants are
// to the centres. False positives rarely agree on a whole value; votes are therefore for values and
// not for single bits, but a value that differs in a bit or two still gets a small share.
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
  Word word;                            // the bits read from it
  float weight = 0;                     // product of its invariants' closeness to the centres, 0..1
  float worst_offset = 0;               // greatest distance from a cell's centre, in half cells
  std::array<float, 32> bit_weights{};  // closeness of the invariant that holds each part bit
};

class Votes {
 public:
  // A value of one part and its score. A ranking lists the best first, and is empty without votes.
  struct Choice {
    std::uint32_t part = 0;
    double score = 0;
  };
  using Ranking = std::vector<Choice>;

  // The probability that a vote is genuine: `most` times a power of its weight.
  struct Trust {
    double most = 0.9;
    double power = 1;
  };

  explicit Votes(const WordCode& code);

  // Counts the vote of one unit.
  void add(const Reading& reading);

  // Returns the best values, at most kRanked, of each part index below 2^s.
  // O(readings * kMostValues) at most, parallel.
  [[nodiscard]] std::vector<Ranking> rankings() const;

  // Returns the best value of each part; nothing where no unit voted.
  [[nodiscard]] std::vector<std::optional<std::uint32_t>> parts() const;

  // Returns the sums of the votes on the bits of every part, part_bits of each: for set less
  // against.
  [[nodiscard]] std::vector<double> balances() const;

  // Returns the log-likelihood ratios of the bits of every part, part_bits of each: of set against
  // clear, 0 without votes. Votes that agree on a whole value weigh more than those that agree on
  // a bit. O(votes * part_bits), parallel.
  [[nodiscard]] std::vector<double> bit_evidence(const Trust& trust) const;

  // What the votes on a part say of one of its values.
  struct Gain {
    std::uint32_t value = 0;
    double log = 0;  // of its likelihood, in relation to that of a value that no vote is near
  };
  // Returns the logarithm of the likelihood of the votes on the part if it has a value that no vote
  // is near, in relation to that of random votes; 0 or less.
  [[nodiscard]] double far_log(std::uint32_t part_index, const Trust& trust) const;
  // Returns the gains of the values that differ from a vote on the part in a bit at most, by
  // ascending value; empty without votes.
  [[nodiscard]] std::vector<Gain> gains(std::uint32_t part_index, const Trust& trust) const;

  // Returns the agreement of the votes on one part, from 0 (tied, or none) to 1 (unanimous): the
  // minimum over its bits of |for - against| / (for + against).
  [[nodiscard]] double agreement(std::uint32_t part_index) const;

  static constexpr std::size_t kRanked = 2;       // decode() tries the best and the second best
  static constexpr std::size_t kMostValues = 64;  // the heaviest are ranked: bounds the time

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
  void weigh_bits(std::uint32_t part_index, const Trust& trust, std::span<double> ratios) const;

  const WordCode* code_;
  std::vector<Bit> bits_;  // part_bits per part
  std::vector<std::vector<Vote>> votes_;
};

}  // namespace triglyph
