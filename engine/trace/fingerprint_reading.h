// Reading of fingerprints from a surface: everything that is said for any name.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "engine/mesh/surface.h"
#include "engine/scheme/encoding.h"
#include "engine/trace/score_table.h"

namespace triglyph {

// The most part bits of a word that carries fingerprints: a table has a score for every value.
inline constexpr int kMostFingerprintBits = 12;

// Returns the word format in which fingerprints are carried where a message has `format`. Against
// colluders every number of a unit carries one bit, the neighbours of whose cells mean the other
// value: between two copies lie the cells of both and nothing else.
[[nodiscard]] WordFormat fingerprint_format(WordFormat format, int colluders);

// Whether a surface is read turned over as well.
enum class ReadTurned : std::uint8_t { No, Yes };

// Returns the tables of all layers: what is read with each of the encodings, whose formats are
// those of fingerprints, and of flux if one of them is; the surface as it is and, if that is
// wanted, turned over. The priors of a layer's tables add up to one at most. O(triangles) for each
// encoding; flux with FluxEffort::All about 80 times. Throws Error Usage for an unknown scheme.
[[nodiscard]] std::vector<ScoreTable> read_fingerprints(const Surface& surface, const Key& key,
                                                        const FingerprintCode& code,
                                                        std::span<const Encoding> encodings,
                                                        FluxEffort effort,
                                                        ReadTurned turned = ReadTurned::Yes);

// What speaks for one name in one layer.
struct LayerEvidence {
  FingerprintLayer layer = FingerprintLayer::Units;
  double bits = 0;
  std::string what;  // the hypothesis that says most
};

struct NameEvidence {
  double bits = 0;  // the sum over the layers
  std::vector<LayerEvidence> layers;
};

// Returns the evidence that the surface that was read carries the fingerprint of a name. For a name
// that has nothing to do with it, evidence of e bits or more has a probability of 2^-e at most:
// everything tried is paid for, but not that other names are tried.
[[nodiscard]] NameEvidence evidence_of(std::span<const ScoreTable> tables,
                                       const FingerprintCode& code, FingerprintSeed seed);

// Returns evidence_of() each of the names. O(tables * names * symbols), parallel.
[[nodiscard]] std::vector<NameEvidence> evidence_of_each(std::span<const ScoreTable> tables,
                                                         const FingerprintCode& code,
                                                         std::span<const FingerprintSeed> seeds);

}  // namespace triglyph
