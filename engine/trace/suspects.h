// Names that may have a copy, by the million.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/trace/fingerprint_reading.h"

namespace triglyph {

// One of the names, and what speaks for it.
struct Scored {
  std::size_t name = 0;
  NameEvidence evidence;
};

// Returns the seeds of names. O(bytes), parallel.
[[nodiscard]] std::vector<FingerprintSeed> seeds_of(
    const FingerprintCode& code, std::span<const std::vector<std::uint8_t>> names);

// Returns the names for which most speaks, at most `most` of them, the first the best; of equals
// the lower number. Of more than some thousand names, those are weighed that do best in the tables
// that promise most; this loses names, not soundness. O(seeds * 300 + names weighed * tables *
// symbols), parallel; the same for any number of threads.
[[nodiscard]] std::vector<Scored> best_of(std::span<const ScoreTable> tables,
                                          const FingerprintCode& code,
                                          std::span<const FingerprintSeed> seeds, std::size_t most);

}  // namespace triglyph
