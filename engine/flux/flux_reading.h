// Blind reading of a flux mark: nothing is known but the key.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/flux/block_code.h"
#include "engine/flux/flux_embedding.h"
#include "engine/flux/lattice.h"
#include "engine/mesh/surface.h"

namespace triglyph {

// A payload, and how it was found.
struct FluxFound {
  FluxPayload payload;
  // Minus the binary logarithm of the probability that any unmarked mesh, or a mesh with the mark
  // of another key, gives a payload at least as likely: evidence less the price of everything
  // tried.
  double evidence = 0;
  std::string undone;  // what was undone before the payload was read: "", "smoothing 30", ..
};

// Evidence, in bits, at which a payload is believed.
inline constexpr double kBelieved = 32;

// How much a reader tries. The price is that of everything in any case.
enum class FluxEffort : std::uint8_t {
  AsItIs,  // the surface as it is: takes one pass over the triangles
  All,
};

// Returns the payload of a surface's flux mark. Tries what may have been done to it (nothing,
// smoothing, curvature flow of several strengths), every order and sign of the axes and mirror
// image, every step, size and content of the payload; each hypothesis pays for itself by its prior,
// so that the probability of a false payload is 2^-kBelieved for the whole reading. O(triangles)
// times about 80.
[[nodiscard]] std::optional<FluxFound> read_flux(const Surface& surface, const Key& key,
                                                 FluxEffort effort = FluxEffort::All);

// Some functionals of a fingerprint have phase 0 whatever the name: pilots, by which a reader
// tells how to read the others without knowing any name. About one in four.
[[nodiscard]] bool is_pilot(std::size_t functional);

// What a surface says of the phases of a fingerprint under one hypothesis of everything else.
struct FluxSoftReading {
  SoftPhases phases;
  double sharpness = 0;
  double prior = 0;  // of the hypothesis, a binary logarithm
  // The binary logarithm of its likelihood by the pilots, whose mean without a mark is one.
  double likelihood = 0;
  std::string undone;
};

// Returns the readings under the hypotheses of which the pilots say most: of what was done to the
// surface, the axes, the step and the sharpness. The priors of all hypotheses add up to one at
// most. O(triangles), times about 80 unless the surface is taken as it is.
[[nodiscard]] std::vector<FluxSoftReading> read_flux_softly(const Surface& surface, const Key& key,
                                                            FluxEffort effort);

// Likewise, of functionals that were estimated; those that are doubted by too much of a step tell
// nothing.
[[nodiscard]] std::vector<FluxSoftReading> read_flux_of_estimate(
    const FluxCanvas::Estimate& estimate, const Key& key);

// What speaks for a word that is known.
struct FluxEvidence {
  double evidence = 0;  // bits, less the price of everything tried; may be negative
  std::string undone;
};

// Returns the evidence that a surface carries a given word under a key: as read_flux(), but without
// the price of a payload. 2^-evidence bounds the probability for an unmarked mesh.
[[nodiscard]] FluxEvidence flux_evidence(const Surface& surface, const Key& key,
                                         const FluxBits& word);

}  // namespace triglyph
