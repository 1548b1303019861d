// Copies of one mesh, each with the fingerprint of a name. What does not depend on the name is
// worked out once: the flux layer's displacements, the units and the symbol that each of them
// carries. Copies thus differ in their bits alone, and whoever combines several cannot do more than
// mix these bits.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "engine/flux/flux_embedding.h"
#include "engine/marking/mark_stages.h"
#include "engine/marking/select_units.h"
#include "engine/message/fingerprint.h"

namespace triglyph {

// Evidence, in bits, that a fingerprint must leave in its file to be of use: it names one of a
// thousand with a false alarm of 2^-30, about 10^-9.
inline constexpr double kTraceable = 40;

// Returns the farthest that points are displaced along each axis where they carry a fingerprint,
// model units, for a surface with this diagonal.
[[nodiscard]] double farthest_of_points(Strength strength, double diagonal);

// Returns the code of the fingerprints that marking makes with these options.
[[nodiscard]] FingerprintCode fingerprint_code(const Key& key, const MarkOptions& options);

// Returns the encodings that such a mark may have: of units that against colluders if it is asked
// for, the usual one and that of small meshes, of which a mesh gets the first that leaves evidence
// enough; then flux.
[[nodiscard]] std::vector<Encoding> fingerprint_encodings(const MarkOptions& options);

// Returns how many of 1,000 recipients can combine their copies such that each of them is still
// named with a false alarm of 10^-9, from the number of bits that units carry one by one.
[[nodiscard]] int colluders_resisted(std::size_t bits);

class CopyPlan {
 public:
  // The task, whose payload is of no meaning here, and all that it refers to must outlive the plan.
  // O(triangles), as marking the layers of the options. Also reads the mesh, to see whether it
  // carries a message of this key already.
  explicit CopyPlan(const MarkTask& task);

  // Returns the mark of a name: a function of mesh, key, options and name, whatever other copies
  // were made. May be called from several threads at a time. TooSmall where the layers have too
  // few bits, TooCoarse where the output's numbers are, TooVisible where the mark would exceed
  // MarkOptions::max_visibility, NoFlux; AlreadyMarked unless MarkOptions::remark is set.
  [[nodiscard]] Marking copy(std::span<const std::uint8_t> name) const;

  [[nodiscard]] bool displaces_points() const { return displaces_points_; }

  // Says whether the output's numbers are too far apart for the cells of units, or for
  // displacements of points.
  [[nodiscard]] bool is_too_coarse() const;

 private:
  struct Units;

  void plan_units();
  // Displaces all points, for meshes with few of them.
  [[nodiscard]] Marking displaced_copy(FingerprintSeed seed) const;
  // Returns the layer of units with one of the encodings.
  [[nodiscard]] std::shared_ptr<const Units> planned_units(const Encoding& encoding) const;
  // Embeds the name's symbols in every `one_in`-th unit of the plan.
  void embed_units(FingerprintSeed seed, std::size_t one_in, Marking& marking) const;
  [[nodiscard]] Marking copy_with(FingerprintSeed seed, std::size_t one_in) const;

  MarkTask task_;
  FingerprintCode code_;
  double diagonal_ = 0;  // model units
  std::optional<FoundMessage> found_;
  std::optional<FluxCanvas> canvas_;
  std::shared_ptr<const Units> units_;  // null: no layer of units
  bool displaces_points_ = false;       // no other layer has bits enough
};

}  // namespace triglyph
