#include "engine/trace/fingerprint_reading.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "engine/base/error.h"
#include "engine/base/stop.h"
#include "engine/scheme/registry.h"

namespace triglyph {
namespace {

// How far units are believed, from a mesh as it was written to one in which noise has moved all
// invariants.
constexpr std::array<Votes::Trust, 4> kTrusts = {{{0.95, 3}, {0.9, 1}, {0.5, 0.25}, {0.15, 0.5}}};

// One bit for each of the four numbers of a unit that carry its part.
constexpr int kBitsAgainstColluders = 4;

// The probability in advance that what a layer seems to say has nothing to do with names, as where
// smoothing moved all units alike; a layer thus speaks against a name by two bits at most.
constexpr double kSaysNothing = 0.25;

void add_unit_tables(std::span<const Reading> readings, const WordCode& words,
                     const FingerprintCode& code, const std::string& what,
                     std::vector<ScoreTable>& tables) {
  Votes votes(words);
  for (const Reading& reading : readings) votes.add(reading);
  for (const Votes::Trust& trust : kTrusts) {
    for (const int colluders : colluders_tried(code)) {
      stop_point();
      ScoreTable table = score_votes(votes, words, trust, code, colluders);
      table.what = what;
      tables.push_back(std::move(table));
    }
  }
}

void add_encoding(const Surface& surface, const Key& key, const FingerprintCode& code,
                  const Encoding& encoding, std::vector<ScoreTable>& tables) {
  const WordCode words(key, encoding.format);
  const auto scheme = make_scheme(encoding.scheme, words, encoding.scheme_options);
  const auto bound = scheme->bind(surface);
  add_unit_tables(bound->read(), words, code, encoding.scheme, tables);
  for (const std::vector<Reading>& readings : bound->read_turned_over()) {
    add_unit_tables(readings, words, code, encoding.scheme + " turned over", tables);
  }
}

void add_flux(const Surface& surface, const Key& key, const FingerprintCode& code,
              FluxEffort effort, std::vector<ScoreTable>& tables) {
  const auto tried = colluders_tried(code);
  for (const FluxSoftReading& reading : read_flux_softly(surface, key, effort)) {
    for (const int colluders : tried) {
      ScoreTable table = score_flux(reading, colluders);
      table.weight = reading.weight - std::log2(static_cast<double>(tried.size()));
      table.what = reading.undone.empty() ? "flux" : "flux, " + reading.undone + " undone";
      tables.push_back(std::move(table));
    }
  }
}

}  // namespace

WordFormat fingerprint_format(WordFormat format, int colluders) {
  format.is_spread = false;
  format.part_bits =
      colluders > 1 ? kBitsAgainstColluders : std::min(format.part_bits, kMostFingerprintBits);
  return format;
}

std::vector<ScoreTable> read_fingerprints(const Surface& surface, const Key& key,
                                          const FingerprintCode& code,
                                          std::span<const Encoding> encodings, FluxEffort effort) {
  std::vector<ScoreTable> tables;
  bool has_flux = false;
  for (const Encoding& encoding : encodings) {
    if (encoding.scheme == kFluxScheme) {
      has_flux = true;
      continue;
    }
    check(encoding.format.part_bits <= kMostFingerprintBits, "a format of fingerprints");
    add_encoding(surface, key, code, encoding, tables);
  }
  for (ScoreTable& table : tables) table.weight -= std::log2(static_cast<double>(tables.size()));
  if (has_flux) add_flux(surface, key, code, effort, tables);
  return tables;
}

// The tables of a layer are added up by their weights, beside those that the layer says nothing.
NameEvidence evidence_of(std::span<const ScoreTable> tables, const FingerprintCode& code,
                         FingerprintSeed seed) {
  NameEvidence all;
  for (auto first = tables.begin(); first != tables.end();) {
    const auto last = std::find_if(
        first, tables.end(), [&](const ScoreTable& table) { return table.layer != first->layer; });
    const double most_weight =
        std::max_element(first, last, [](const ScoreTable& a, const ScoreTable& b) {
          return a.weight < b.weight;
        })->weight;
    std::vector<double> logs;
    double weights = 0;
    for (auto table = first; table != last; ++table) {
      weights += std::exp2(table->weight - most_weight);
      logs.push_back(table->weight - most_weight + table->score(code, seed));
    }
    const auto best = std::max_element(logs.begin(), logs.end());
    double sum = 0;
    for (const double log : logs) sum += std::exp2(log - *best);
    // what the tables say of the name, together
    const double said = std::log2(sum / weights) + *best;
    const double larger = std::max(said, 0.0);
    const double bits = std::log2((1 - kSaysNothing) * std::exp2(said - larger) +
                                  kSaysNothing * std::exp2(-larger)) +
                        larger;
    const auto at = static_cast<std::size_t>(best - logs.begin());
    all.layers.push_back({first->layer, bits, first[at].what});
    all.bits += bits;
    first = last;
  }
  return all;
}

}  // namespace triglyph
