#include "engine/message/votes.h"

#include <algorithm>
#include <cmath>

namespace triglyph {

Votes::Votes(const WordCode& code)
    : code_(&code),
      bits_(std::size_t{code.capacity()} * static_cast<std::size_t>(code.format().part_bits)),
      voters_(code.capacity()) {}

void Votes::add(const Reading& reading) {
  const auto part_bits = static_cast<std::size_t>(code_->format().part_bits);
  const std::uint32_t index = code_->part_index(reading.word.subscript);
  ++voters_[index];
  for (std::size_t bit = 0; bit < part_bits; ++bit) {
    Bit& tally = bits_[index * part_bits + bit];
    const double weight = double{reading.weight} * double{reading.bit_weights[bit]};
    ((reading.word.part >> bit) & 1 ? tally.set : tally.clear) += weight;
  }
}

std::vector<std::optional<std::uint32_t>> Votes::parts() const {
  const auto part_bits = static_cast<std::size_t>(code_->format().part_bits);
  std::vector<std::optional<std::uint32_t>> decided(voters_.size());
  for (std::size_t index = 0; index < voters_.size(); ++index) {
    if (voters_[index] == 0) continue;
    std::uint32_t part = 0;
    for (std::size_t bit = 0; bit < part_bits; ++bit) {
      const Bit& tally = bits_[index * part_bits + bit];
      if (tally.set > tally.clear) part |= 1U << bit;
    }
    decided[index] = part;
  }
  return decided;
}

double Votes::agreement(std::uint32_t part_index) const {
  const auto part_bits = static_cast<std::size_t>(code_->format().part_bits);
  double least = 1;
  for (std::size_t bit = 0; bit < part_bits; ++bit) {
    const Bit& tally = bits_[part_index * part_bits + bit];
    const double total = tally.set + tally.clear;
    least = std::min(least, total > 0 ? std::abs(tally.set - tally.clear) / total : 0.0);
  }
  return least;
}

}  // namespace triglyph
