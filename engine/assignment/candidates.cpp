#include "engine/assignment/candidates.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace triglyph {
namespace {

constexpr std::size_t kLanes = 8;            // independent minima, so that the loop vectorises
constexpr std::size_t kChunksPerWanted = 2;  // more give a sharper cut, fewer a cheaper one
constexpr std::size_t kTiesPerWanted = 2;    // most tied units in a list, per pair wanted

double key_of(float cost, double price) {
  return static_cast<double>(cost) + price;
}

CandidateList list_all(std::span<const float> column, std::span<const double> prices) {
  CandidateList list{{}, kInfinity};
  for (std::size_t unit = 0; unit < column.size(); ++unit) {
    if (key_of(column[unit], prices[unit]) < kInfinity) {
      list.pairs.push_back({static_cast<std::uint32_t>(unit), column[unit]});
    }
  }
  return list;
}

std::vector<double> find_chunk_minima(std::span<const float> column, std::span<const double> prices,
                                      std::size_t length) {
  std::vector<double> minima((column.size() + length - 1) / length);
  for (std::size_t chunk = 0; chunk < minima.size(); ++chunk) {
    const std::size_t end = std::min(column.size(), (chunk + 1) * length);
    // separate lanes: a single running minimum cannot be vectorised
    std::array<double, kLanes> least;
    least.fill(kInfinity);
    std::size_t unit = chunk * length;
    for (; unit + kLanes <= end; unit += kLanes) {
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const double key = key_of(column[unit + lane], prices[unit + lane]);
        least[lane] = key < least[lane] ? key : least[lane];
      }
    }
    for (; unit < end; ++unit) {
      least[0] = std::min(least[0], key_of(column[unit], prices[unit]));
    }
    minima[chunk] = *std::min_element(least.begin(), least.end());
  }
  return minima;
}

}  // namespace

// The wanted-th smallest of the chunks' minima is a cut with at least `wanted` pairs at or below
// it, found without sorting the column. Units that tie at the cut are collected from a start that
// differs between words: if a thousand units cost the same under every word, words then list
// different ones.
CandidateList pick_candidates(std::span<const float> column, std::span<const double> prices,
                              const CandidateQuery& query) {
  const std::size_t length =
      column.size() / (kChunksPerWanted * std::max<std::size_t>(1, query.wanted));
  if (length < 2) return list_all(column, prices);
  const std::vector<double> minima = find_chunk_minima(column, prices, length);
  std::vector<double> ordered = minima;
  const auto nth = ordered.begin() + static_cast<std::ptrdiff_t>(query.wanted) - 1;
  std::nth_element(ordered.begin(), nth, ordered.end());
  const double cut = *nth;
  if (cut == kInfinity) return list_all(column, prices);

  CandidateList list;
  list.pairs.reserve(2 * query.wanted);
  std::size_t ties_left = kTiesPerWanted * query.wanted;
  bool left_out_ties = false;
  const std::size_t first = query.spread % minima.size();
  for (std::size_t k = 0; k < minima.size(); ++k) {
    const std::size_t chunk = (first + k) % minima.size();
    if (minima[chunk] > cut) continue;
    const std::size_t end = std::min(column.size(), (chunk + 1) * length);
    for (std::size_t unit = chunk * length; unit < end; ++unit) {
      const double key = key_of(column[unit], prices[unit]);
      if (key > cut) continue;
      if (key == cut) {
        if (ties_left == 0) {
          left_out_ties = true;
          continue;
        }
        --ties_left;
      }
      list.pairs.push_back({static_cast<std::uint32_t>(unit), column[unit]});
    }
  }
  list.bound = left_out_ties ? cut : std::nextafter(cut, kInfinity);
  return list;
}

}  // namespace triglyph
