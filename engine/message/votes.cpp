#include "engine/message/votes.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>

#include "engine/base/parallel.h"

namespace triglyph {
namespace {

// Share of a vote for a value that differs in one bit, if that bit was read at the centre of its
// cell.
constexpr double kMismatch = 0.15;

}  // namespace

Votes::Votes(const WordCode& code)
    : code_(&code),
      bits_(std::size_t{code.capacity()} * static_cast<std::size_t>(code.format().part_bits)),
      votes_(code.capacity()) {}

void Votes::add(const Reading& reading) {
  const auto part_bits = static_cast<std::size_t>(code_->format().part_bits);
  const std::uint32_t index = code_->part_index(reading.word.subscript);
  votes_[index].push_back({reading.word.part, reading.weight, reading.bit_weights});
  for (std::size_t bit = 0; bit < part_bits; ++bit) {
    Bit& tally = bits_[index * part_bits + bit];
    const double weight = double{reading.weight} * double{reading.bit_weights[bit]};
    ((reading.word.part >> bit) & 1 ? tally.set : tally.clear) += weight;
  }
}

Votes::Ranking Votes::rank(const std::vector<Vote>& votes) const {
  std::map<std::uint32_t, double> weight_of;
  for (const Vote& vote : votes) weight_of[vote.part] += double{vote.weight};
  Ranking ranking;
  for (const auto& [part, weight] : weight_of) ranking.push_back({part, weight});
  const auto better = [](const Choice& a, const Choice& b) {
    return a.score != b.score ? a.score > b.score : a.part < b.part;
  };
  std::sort(ranking.begin(), ranking.end(), better);
  if (ranking.size() > kMostValues) ranking.resize(kMostValues);
  for (Choice& choice : ranking) {
    choice.score = 0;
    for (const Vote& vote : votes) {
      double score = double{vote.weight};
      for (std::uint32_t other = vote.part ^ choice.part; other != 0; other &= other - 1) {
        const auto bit = static_cast<std::size_t>(std::countr_zero(other));
        score *= 1 - (1 - kMismatch) * double{vote.bit_weights[bit]};
      }
      choice.score += score;
    }
  }
  std::sort(ranking.begin(), ranking.end(), better);
  if (ranking.size() > kRanked) ranking.resize(kRanked);
  return ranking;
}

std::vector<Votes::Ranking> Votes::rankings() const {
  std::vector<Ranking> rankings(votes_.size());
  parallel_for(votes_.size(), [&](std::size_t index) { rankings[index] = rank(votes_[index]); });
  return rankings;
}

std::vector<std::optional<std::uint32_t>> Votes::parts() const {
  std::vector<std::optional<std::uint32_t>> decided(votes_.size());
  const std::vector<Ranking> all = rankings();
  for (std::size_t index = 0; index < all.size(); ++index) {
    if (!all[index].empty()) decided[index] = all[index][0].part;
  }
  return decided;
}

std::vector<double> Votes::balances() const {
  std::vector<double> sums;
  for (const Bit& tally : bits_) sums.push_back(tally.set - tally.clear);
  return sums;
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
