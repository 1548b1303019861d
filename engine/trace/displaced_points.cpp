#include "engine/trace/displaced_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace triglyph {
namespace {

constexpr std::size_t kMostFixed = 4;
constexpr int kLevels = 1 << kPointBits;

// What disturbed the points, in relation to the farthest displacement: from the rounding of floats
// to noise as large as the mark.
constexpr std::array<double, 5> kDisturbances = {1.0 / 64, 1.0 / 16, 1.0 / 4, 1.0 / 2, 1};

// The probability that a point was disturbed by something else, far more.
constexpr double kStray = 0.02;

// The displacement of a level, from -1 to 1.
double displacement_of(int level) {
  return (2 * level + 1) / double{kLevels} - 1;
}

std::uint32_t symbol_of(std::size_t point, std::size_t axis) {
  return static_cast<std::uint32_t>(3 * point + axis);
}

// Appends the scores of a coordinate that was seen `offset` times the farthest displacement from
// its place, and returns the logarithm of their mean likelihood.
double append_levels(double offset, double disturbance, std::vector<float>& scores) {
  std::array<double, kLevels> likelihood{};
  double mean = 0;
  for (int level = 0; level < kLevels; ++level) {
    const double miss = (offset - displacement_of(level)) / disturbance;
    likelihood[static_cast<std::size_t>(level)] =
        kStray + (1 - kStray) * std::exp(-miss * miss / 2) / disturbance;
    mean += likelihood[static_cast<std::size_t>(level)] / kLevels;
  }
  for (const double one : likelihood) scores.push_back(static_cast<float>(std::log2(one / mean)));
  return std::log(mean);
}

}  // namespace

std::vector<std::uint32_t> fixed_points(std::span<const Vec3> positions) {
  std::vector<std::uint32_t> fixed;
  std::vector<double> nearest(positions.size(), std::numeric_limits<double>::infinity());
  // the first is the farthest from the first of all
  Vec3 last = positions.empty() ? Vec3() : positions[0];
  const std::size_t most = std::min(kMostFixed, positions.size() / 2);
  while (fixed.size() < most) {
    for (std::size_t i = 0; i < positions.size(); ++i) {
      nearest[i] = std::min(nearest[i], (positions[i] - last).sqrnorm());
    }
    const auto farthest = std::max_element(nearest.begin(), nearest.end());
    const auto point = static_cast<std::uint32_t>(farthest - nearest.begin());
    if (fixed.empty())
      std::fill(nearest.begin(), nearest.end(), std::numeric_limits<double>::infinity());
    last = positions[point];
    fixed.push_back(point);
  }
  std::sort(fixed.begin(), fixed.end());
  return fixed;
}

std::vector<Vec3> displaced(std::span<const Vec3> positions, double farthest,
                            const FingerprintCode& code, FingerprintSeed seed) {
  const std::vector<std::uint32_t> fixed = fixed_points(positions);
  std::vector<Vec3> result(positions.begin(), positions.end());
  for (std::size_t i = 0; i < result.size(); ++i) {
    if (std::binary_search(fixed.begin(), fixed.end(), i)) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::uint32_t level =
          code.fair_symbol(seed, FingerprintLayer::Points, symbol_of(i, axis), kPointBits);
      result[i][axis] += farthest * displacement_of(static_cast<int>(level));
    }
  }
  return result;
}

std::vector<ScoreTable> score_points(std::span<const Vec3> original,
                                     std::span<const std::optional<Vec3>> seen, double farthest,
                                     int ways) {
  const std::vector<std::uint32_t> fixed = fixed_points(original);
  std::vector<ScoreTable> tables;
  for (const double disturbance : kDisturbances) {
    ScoreTable& table = tables.emplace_back();
    table.layer = FingerprintLayer::Points;
    table.bits = kPointBits;
    table.what = "points";
    table.prior = -std::log2(static_cast<double>(kDisturbances.size()) * ways);
    for (std::size_t i = 0; i < original.size(); ++i) {
      if (!seen[i] || std::binary_search(fixed.begin(), fixed.end(), i)) continue;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double offset = ((*seen[i])[axis] - original[i][axis]) / farthest;
        table.symbols.push_back(symbol_of(i, axis));
        table.likelihood += append_levels(offset, disturbance, table.scores) / M_LN2;
      }
    }
  }
  return tables;
}

}  // namespace triglyph
