#include "engine/trace/fingerprint_reading.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/base/error.h"
#include "engine/base/parallel.h"
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
                  const Encoding& encoding, ReadTurned turned, std::vector<ScoreTable>& tables) {
  const WordCode words(key, encoding.format);
  const auto scheme = make_scheme(encoding.scheme, words, encoding.scheme_options);
  const auto bound = scheme->bind(surface);
  const WordFormat& format = encoding.format;
  const std::string what = encoding.scheme + " m" + std::to_string(format.marker_bits) + " s" +
                           std::to_string(format.subscript_bits) + " w" +
                           std::to_string(format.part_bits);
  add_unit_tables(bound->read(), words, code, what, tables);
  if (turned == ReadTurned::No) return;
  for (const std::vector<Reading>& readings : bound->read_turned_over()) {
    add_unit_tables(readings, words, code, what + ", turned over", tables);
  }
}

void add_flux(const Surface& surface, const Key& key, const FingerprintCode& code,
              FluxEffort effort, std::vector<ScoreTable>& tables) {
  const auto tried = colluders_tried(code);
  for (const FluxSoftReading& reading : read_flux_softly(surface, key, effort)) {
    for (const int colluders : tried) {
      ScoreTable table = score_flux(reading, colluders);
      table.prior -= std::log2(static_cast<double>(tried.size()));
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
                                          std::span<const Encoding> encodings, FluxEffort effort,
                                          ReadTurned turned) {
  std::vector<ScoreTable> tables;
  bool has_flux = false;
  for (const Encoding& encoding : encodings) {
    if (encoding.scheme == kFluxScheme) {
      has_flux = true;
      continue;
    }
    check(encoding.format.part_bits <= kMostFingerprintBits, "a format of fingerprints");
    add_encoding(surface, key, code, encoding, turned, tables);
  }
  for (ScoreTable& table : tables) table.prior = -std::log2(static_cast<double>(tables.size()));
  if (has_flux) add_flux(surface, key, code, effort, tables);
  return tables;
}

namespace {

// Returns the binary logarithm of a sum of powers of two.
template <typename Exponent>
double log_of_sum(std::size_t count, const Exponent& exponent) {
  double most = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < count; ++i) most = std::max(most, exponent(i));
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i) sum += std::exp2(exponent(i) - most);
  return std::log2(sum) + most;
}

// The tables of a layer are added up, half by their weights and half by their priors alone, since
// what was done to a mesh may suit no hypothesis and then favour a wrong one; beside those that the
// layer says nothing. `scores` are those of the tables for one name.
LayerEvidence layer_evidence(std::span<const ScoreTable> tables, std::span<const double> scores) {
  const std::size_t count = tables.size();
  const auto normalised = [&](const auto& weight) {
    const double all = log_of_sum(count, weight);
    return log_of_sum(count, [&](std::size_t t) { return weight(t) + scores[t]; }) - all;
  };
  const std::array<double, 2> said = {normalised([&](std::size_t t) { return tables[t].weight(); }),
                                      normalised([&](std::size_t t) { return tables[t].prior; })};
  const double bits = log_of_sum(3, [&](std::size_t i) {
    return i < 2 ? std::log2((1 - kSaysNothing) / 2) + said.at(i) : std::log2(kSaysNothing);
  });
  std::size_t best = 0;
  for (std::size_t t = 1; t < count; ++t) {
    if (tables[t].prior + scores[t] > tables[best].prior + scores[best]) best = t;
  }
  return {tables[0].layer, bits, tables[best].what};
}

// The tables of one layer, which follow each other.
template <typename Visit>
void for_each_layer(std::span<const ScoreTable> tables, const Visit& visit) {
  for (std::size_t first = 0; first < tables.size();) {
    std::size_t last = first;
    while (last < tables.size() && tables[last].layer == tables[first].layer) ++last;
    visit(tables.subspan(first, last - first));
    first = last;
  }
}

// Calls the function for every run of tables whose symbols have as many bits.
template <typename Visit>
void for_each_width(std::span<const ScoreTable> tables, const Visit& visit) {
  for (std::size_t first = 0; first < tables.size();) {
    std::size_t last = first;
    while (last < tables.size() && tables[last].bits == tables[first].bits) ++last;
    visit(first, last);
    first = last;
  }
}

}  // namespace

std::vector<NameEvidence> evidence_of_each(std::span<const ScoreTable> tables,
                                           const FingerprintCode& code,
                                           std::span<const FingerprintSeed> seeds) {
  std::vector<NameEvidence> all(seeds.size());
  for_each_layer(tables, [&](std::span<const ScoreTable> layer) {
    std::vector<double> scores(seeds.size() * layer.size());  // by name
    for_each_width(layer, [&](std::size_t first, std::size_t last) {
      std::vector<char> is_read;
      for (std::size_t t = first; t < last; ++t) {
        for (const std::uint32_t symbol : layer[t].symbols) {
          if (symbol >= is_read.size()) is_read.resize(symbol + 1, 0);
          is_read[symbol] = 1;
        }
      }
      std::vector<std::uint16_t> values(seeds.size() * is_read.size());  // by name
      parallel_for(
          seeds.size(),
          [&](std::size_t name) {
            for (std::uint32_t symbol = 0; symbol < is_read.size(); ++symbol) {
              if (is_read[symbol] == 0) continue;
              values[name * is_read.size() + symbol] =
                  static_cast<std::uint16_t>(layer[first].value_of(code, seeds[name], symbol));
            }
          },
          16);
      stop_point();
      // a table after the other, which stays in the cache
      parallel_for(last - first, [&](std::size_t t) {
        for (std::size_t name = 0; name < seeds.size(); ++name) {
          scores[name * layer.size() + first + t] = layer[first + t].score(
              std::span(values).subspan(name * is_read.size(), is_read.size()));
        }
      });
    });
    parallel_for(
        seeds.size(),
        [&](std::size_t name) {
          all[name].layers.push_back(
              layer_evidence(layer, std::span(scores).subspan(name * layer.size(), layer.size())));
          all[name].bits += all[name].layers.back().bits;
        },
        16);
  });
  return all;
}

NameEvidence evidence_of(std::span<const ScoreTable> tables, const FingerprintCode& code,
                         FingerprintSeed seed) {
  return std::move(evidence_of_each(tables, code, std::span(&seed, 1))[0]);
}

}  // namespace triglyph
