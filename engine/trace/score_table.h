// What a reading of a mesh says for and against every fingerprint, in a form in which millions of
// fingerprints are scored.
//
// A score is the logarithm of a likelihood whose mean over names drawn at random is one, whatever
// the mesh and whatever was done to it: only the secret bits of the name are random. By Markov's
// inequality a name that has nothing to do with the mesh scores e bits or more with a probability
// of 2^-e at most. Nothing is assumed of the mesh or of whoever attacked it.
//
// This work is based on:
// Laarhoven. Capacities and capacity-achieving decoders for various fingerprinting games. IH&MMSec
// (2014): likelihoods under the interleaving attack, which are good against any other.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/flux/flux_reading.h"
#include "engine/message/fingerprint.h"
#include "engine/message/votes.h"

namespace triglyph {

// The scores of the symbols of one layer under one hypothesis.
struct ScoreTable {
  FingerprintLayer layer = FingerprintLayer::Units;
  int bits = 0;                        // of a symbol
  std::vector<std::uint32_t> symbols;  // the numbers of those that were read, ascending
  std::vector<float> scores;           // 2^bits for each of these, in bits
  double prior = 0;                    // of the hypothesis, a binary logarithm
  // The binary logarithm of its likelihood over all names, in relation to a mesh without a mark:
  // weighing hypotheses by it favours no name.
  double likelihood = 0;
  int colluders = 1;  // of whom each is as likely to have written a bit
  std::string what;   // the hypothesis in words

  [[nodiscard]] double weight() const { return prior + likelihood; }

  // Returns the score of a name. O(symbols).
  [[nodiscard]] double score(const FingerprintCode& code, FingerprintSeed seed) const;

  // Likewise of a name whose symbols are known by their numbers.
  [[nodiscard]] double score(std::span<const std::uint16_t> values) const;

  // Returns the symbol of a name with the number of one of this table's.
  [[nodiscard]] std::uint32_t value_of(const FingerprintCode& code, FingerprintSeed seed,
                                       std::uint32_t symbol) const;
};

// Numbers of colluders that a reader allows for.
[[nodiscard]] std::span<const int> colluders_tried(const FingerprintCode& code);

// Returns a table of the votes on the parts of words, each of which is a symbol that has the
// number of the word's subscript.
[[nodiscard]] ScoreTable score_votes(const Votes& votes, const WordCode& words,
                                     const Votes::Trust& trust, const FingerprintCode& code,
                                     int colluders);

// A symbol of a flux layer is the phase of a functional in 2^-kFluxPhaseBits cells.
inline constexpr int kFluxPhaseBits = 6;

// Returns the phases of a name: those of its symbols, and 0 for pilots.
[[nodiscard]] FluxPhases phases_of_name(const FingerprintCode& code, FingerprintSeed seed);

// Returns a table of the soft phases of a flux mark, each of which is a symbol.
[[nodiscard]] ScoreTable score_flux(const FluxSoftReading& reading, int colluders);

}  // namespace triglyph
