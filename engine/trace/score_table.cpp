#include "engine/trace/score_table.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace triglyph {
namespace {

constexpr std::array<int, 2> kFewColluders = {1, 2};
constexpr std::array<int, 4> kManyColluders = {1, 2, 3, 5};

// The score of a bit that is clear and of one that is set, nats.
using BitScores = std::array<double, 2>;

// Returns the scores of a bit whose readings are `odds` times as likely if the copy in hand has it
// set as if it has it clear, and which is set in a name with probability `bias`. Of c colluders one
// wrote it, whoever it was: with probability 1 / c the one who is accused.
BitScores bit_scores(double odds, double bias, int colluders) {
  const double own = 1.0 / colluders;
  const double other_set = (1 - own) * bias;
  const double other_clear = (1 - own) * (1 - bias);
  // scaled such that nothing overflows
  const double set = odds > 1 ? 1 : odds;
  const double clear = odds > 1 ? 1 / odds : 1;
  const double mean = bias * set + (1 - bias) * clear;
  return {std::log((other_set * set + (own + other_clear) * clear) / mean),
          std::log(((own + other_set) * set + other_clear * clear) / mean)};
}

// Appends the scores of all values of a symbol, whose bits are scored one by one.
void append_values(std::span<const BitScores> bits, std::vector<float>& scores) {
  const std::size_t first = scores.size();
  scores.resize(first + (std::size_t{1} << bits.size()));
  for (std::size_t value = 0; value < std::size_t{1} << bits.size(); ++value) {
    double nats = 0;
    for (std::size_t bit = 0; bit < bits.size(); ++bit) nats += bits[bit][value >> bit & 1];
    scores[first + value] = static_cast<float>(nats / M_LN2);
  }
}

// Appends the scores of all values of a symbol that one copy wrote, from the likelihoods of the
// values. Returns the logarithm of the mean likelihood over names.
double append_values(std::span<const Votes::Gain> gains, std::uint32_t symbol, int bits,
                     const FingerprintCode& code, std::vector<float>& scores) {
  std::vector<double> logs(std::size_t{1} << bits, 0);
  double most = 0;
  for (const Votes::Gain& gain : gains) {
    logs[gain.value] = gain.log;
    most = std::max(most, gain.log);
  }
  std::vector<double> bias;
  for (int bit = 0; bit < bits; ++bit) {
    const auto number = symbol * static_cast<std::uint32_t>(bits) + static_cast<std::uint32_t>(bit);
    bias.push_back(code.bias(FingerprintLayer::Units, number));
  }
  double mean = 0;  // over names
  for (std::size_t value = 0; value < logs.size(); ++value) {
    double chance = 1;
    for (std::size_t bit = 0; bit < bias.size(); ++bit) {
      chance *= (value >> bit & 1) != 0 ? bias[bit] : 1 - bias[bit];
    }
    mean += chance * std::exp(logs[value] - most);
  }
  const double log_mean = std::log(mean) + most;
  for (const double log : logs) scores.push_back(static_cast<float>((log - log_mean) / M_LN2));
  return log_mean;
}

}  // namespace

std::uint32_t ScoreTable::value_of(const FingerprintCode& code, FingerprintSeed seed,
                                   std::uint32_t symbol) const {
  return layer == FingerprintLayer::Units ? code.symbol(seed, layer, symbol, bits)
                                          : code.fair_symbol(seed, layer, symbol, bits);
}

double ScoreTable::score(const FingerprintCode& code, FingerprintSeed seed) const {
  double sum = 0;
  const float* row = scores.data();
  const bool is_fair = layer != FingerprintLayer::Units || code.is_fair();
  const std::uint64_t draw = FingerprintCode::draw_of(seed, layer);
  for (const std::uint32_t symbol : symbols) {
    const std::uint32_t value = is_fair ? FingerprintCode::fair_symbol(draw, symbol, bits)
                                        : code.symbol(seed, layer, symbol, bits);
    sum += double{row[value]};
    row += std::size_t{1} << bits;
  }
  return sum;
}

double ScoreTable::score(std::span<const std::uint16_t> values) const {
  double sum = 0;
  const float* row = scores.data();
  for (const std::uint32_t symbol : symbols) {
    sum += double{row[values[symbol]]};
    row += std::size_t{1} << bits;
  }
  return sum;
}

std::span<const int> colluders_tried(const FingerprintCode& code) {
  return code.is_fair() ? std::span<const int>(kFewColluders)
                        : std::span<const int>(kManyColluders);
}

ScoreTable score_votes(const Votes& votes, const WordCode& words, const Votes::Trust& trust,
                       const FingerprintCode& code, int colluders) {
  ScoreTable table;
  table.layer = FingerprintLayer::Units;
  table.colluders = colluders;
  table.bits = words.format().part_bits;
  const auto width = static_cast<std::size_t>(table.bits);
  const std::vector<double> ratios =
      colluders > 1 ? votes.bit_evidence(trust) : std::vector<double>();
  for (std::uint32_t symbol = 0; symbol < words.capacity(); ++symbol) {
    const std::uint32_t index = words.part_index(symbol);
    const std::vector<Votes::Gain> gains = votes.gains(index, trust);
    if (gains.empty()) continue;
    table.symbols.push_back(symbol);
    std::vector<float> alone;
    const double log_mean = append_values(gains, symbol, table.bits, code, alone);
    table.likelihood += (votes.far_log(index, trust) + log_mean) / M_LN2;
    if (colluders == 1) {
      table.scores.insert(table.scores.end(), alone.begin(), alone.end());
      continue;
    }
    std::vector<BitScores> bits;
    for (std::size_t bit = 0; bit < width; ++bit) {
      const auto number = static_cast<std::uint32_t>(symbol * width + bit);
      bits.push_back(bit_scores(std::exp(ratios[index * width + bit]),
                                code.bias(FingerprintLayer::Units, number), colluders));
    }
    append_values(bits, table.scores);
  }
  return table;
}

FluxPhases phases_of_name(const FingerprintCode& code, FingerprintSeed seed) {
  FluxPhases phases{};
  for (std::uint32_t i = 0; i < kFunctionals; ++i) {
    if (is_pilot(i)) continue;
    const std::uint32_t symbol = code.fair_symbol(seed, FingerprintLayer::Flux, i, kFluxPhaseBits);
    phases[i] = std::ldexp(static_cast<double>(symbol), -kFluxPhaseBits);
  }
  return phases;
}

// What one of several colluders wrote is a phase of the name with the probability of its share, or
// else random.
ScoreTable score_flux(const FluxSoftReading& reading, int colluders) {
  ScoreTable table;
  table.layer = FingerprintLayer::Flux;
  table.prior = reading.prior;
  table.likelihood = reading.likelihood;
  table.colluders = colluders;
  table.bits = kFluxPhaseBits;
  const double log_mean = log_bessel(reading.sharpness);
  const double share = 1.0 / colluders;
  for (std::uint32_t i = 0; i < kFunctionals; ++i) {
    if (is_pilot(i) || reading.phases[i].used == 0) continue;
    table.symbols.push_back(i);
    for (int level = 0; level < 1 << kFluxPhaseBits; ++level) {
      const double nats = reading.phases[i].log_likelihood(std::ldexp(level, -kFluxPhaseBits),
                                                           reading.sharpness, log_mean);
      table.scores.push_back(static_cast<float>(std::log2(1 - share + share * std::exp(nats))));
    }
  }
  return table;
}

}  // namespace triglyph
