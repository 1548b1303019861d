// Which marks come back after what: a scheme, a mesh, several keys, and a list of attacks.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/attack/attack.h"
#include "engine/marking/options.h"
#include "engine/mesh/mesh.h"

namespace triglyph {

struct SurvivalOptions {
  int keys = 4;            // marks made of each mesh, each attacked by lots of its own
  std::uint64_t seed = 1;  // of the attacks
};

// What became of the marks of one mesh, or of several, under one attack.
struct AttackSurvival {
  std::string attack;
  std::vector<double> wrong_bits;  // of each mark that was attacked, see TrialReading
  std::uint32_t recovered = 0;     // marks whose message was read
  double worst_false_alarm = 0;    // the greatest of the readings that succeeded
  std::uint32_t not_applied = 0;   // marked meshes that are too large for the attack

  [[nodiscard]] double median_wrong_bits() const;  // 1 if there are none
  [[nodiscard]] double worst_wrong_bits() const;   // likewise
  bool operator==(const AttackSurvival&) const = default;
};

// What a mark does to a mesh before any attack. Lengths are relative to the mesh's diagonal.
struct MarkDistortion {
  double mrms_rel_diag = 0;       // greater root mean square distance of both directions; first key
  double hausdorff_rel_diag = 0;  // the worst of all keys
  double msdm2 = 0;               // perceptual, 0 to 1; first key
  double normal_mean_degrees = 0;  // how far normals turn, the mean over area and keys
  double normal_max_degrees = 0;   // the worst of all keys

  bool operator==(const MarkDistortion&) const = default;
};

// The marks of one scheme.
struct SchemeSurvival {
  std::uint32_t meshes_tried = 0;  // meshes times keys
  std::uint32_t marked = 0;
  std::string refusal;        // why the first of the others was not marked; empty: all were
  MarkDistortion distortion;  // of those that were marked
  std::vector<AttackSurvival> attacks;

  bool operator==(const SchemeSurvival&) const = default;
};

// Marks a mesh as the request says under each of the public trial keys, attacks every mark, stores
// the result as floats and reads it. The result is the same for any number of threads. Throws Error
// Usage as mark_for_trial() does, and Stopped. Takes keys * attacks times as long as an attack and
// a reading.
[[nodiscard]] SchemeSurvival survive(const Mesh& mesh, const MarkRequest& request,
                                     std::span<const Attack> attacks,
                                     const SurvivalOptions& options);

// Returns the result of all parts together, which have the same attacks: counts add up, the worst
// is the worst of all, means are over the parts that were marked.
[[nodiscard]] SchemeSurvival combined(std::span<const SchemeSurvival> parts);

}  // namespace triglyph
