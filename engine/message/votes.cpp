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

// Likewise if a genuine vote gives it, in relation to that for the right value.
constexpr double kLeastOdds = 0.05;

// No bit is surer than this, in relation to the likeliest value.
constexpr double kLeastShare = 1e-9;

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

// The value of the part is v in advance with equal probability. A vote is genuine with a
// probability that its weight tells, and then has each bit of v but for an error that the bit's
// weight tells; or else it is random. Values that differ from a vote in two bits or more are as
// likely under it as if it were random.
std::vector<Votes::Gain> Votes::gains(std::uint32_t part_index, const Trust& trust) const {
  const auto part_bits = static_cast<std::size_t>(code_->format().part_bits);
  const double values = std::ldexp(1.0, code_->format().part_bits);
  std::vector<Gain> gains;
  for (const Vote& vote : votes_[part_index]) {
    const double genuine = trust.most * std::pow(double{vote.weight}, trust.power);
    double exact = 1;               // probability that a genuine vote has all bits right
    std::array<double, 32> odds{};  // of an error
    for (std::size_t bit = 0; bit < part_bits; ++bit) {
      odds[bit] = 1 - (1 - kLeastOdds) * double{vote.bit_weights[bit]};
      exact /= 1 + odds[bit];
    }
    const double far = 1 - genuine;
    gains.push_back({vote.part, std::log1p(genuine * values * exact / far)});
    for (std::size_t bit = 0; bit < part_bits; ++bit) {
      gains.push_back(
          {vote.part ^ 1U << bit, std::log1p(genuine * values * exact * odds[bit] / far)});
    }
  }
  std::sort(gains.begin(), gains.end(), [](const Gain& a, const Gain& b) {
    return a.value != b.value ? a.value < b.value : a.log < b.log;
  });
  std::size_t kept = 0;  // values, each with its sum
  for (std::size_t i = 0; i < gains.size(); ++i) {
    if (kept > 0 && gains[kept - 1].value == gains[i].value) {
      gains[kept - 1].log += gains[i].log;
    } else {
      gains[kept++] = gains[i];
    }
  }
  gains.resize(kept);
  return gains;
}

double Votes::far_log(std::uint32_t part_index, const Trust& trust) const {
  double sum = 0;
  for (const Vote& vote : votes_[part_index]) {
    sum += std::log1p(-trust.most * std::pow(double{vote.weight}, trust.power));
  }
  return sum;
}

void Votes::weigh_bits(std::uint32_t part_index, const Trust& trust,
                       std::span<double> ratios) const {
  const std::vector<Gain> known = gains(part_index, trust);
  if (known.empty()) return;
  const auto part_bits = static_cast<std::size_t>(code_->format().part_bits);
  const double values = std::ldexp(1.0, code_->format().part_bits);
  double most = 0;
  for (const Gain& gain : known) most = std::max(most, gain.log);
  const double others = (values - static_cast<double>(known.size())) * std::exp(-most);
  std::vector<double> set(part_bits, others / 2), clear(part_bits, others / 2);
  for (const Gain& gain : known) {
    const double share = std::exp(gain.log - most);
    for (std::size_t bit = 0; bit < part_bits; ++bit) {
      ((gain.value >> bit) & 1 ? set : clear)[bit] += share;
    }
  }
  for (std::size_t bit = 0; bit < part_bits; ++bit) {
    ratios[bit] = std::log(std::max(set[bit], kLeastShare) / std::max(clear[bit], kLeastShare));
  }
}

std::vector<double> Votes::bit_evidence(const Trust& trust) const {
  const auto part_bits = static_cast<std::size_t>(code_->format().part_bits);
  std::vector<double> ratios(bits_.size(), 0);
  parallel_for(votes_.size(), [&](std::size_t index) {
    weigh_bits(static_cast<std::uint32_t>(index), trust,
               std::span(ratios).subspan(index * part_bits, part_bits));
  });
  return ratios;
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
