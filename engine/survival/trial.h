// One mark, made in memory and read back blind: the two functions that are all that a measurement
// of survival knows of marking.
#pragma once

#include <optional>
#include <string>

#include "engine/flux/flux_mark.h"
#include "engine/marking/options.h"
#include "engine/mesh/mesh.h"
#include "engine/message/key.h"

namespace triglyph {

// A mesh with a mark, as a file of floats holds it, and what its reader must know.
struct TrialMark {
  std::string refusal;  // why the mesh is not marked; empty: it is
  Mesh mesh;
  Encoding encoding;  // of the layer of units
  Message message;
  std::optional<FluxMark> flux;  // the flux layer
  bool has_units = true;

  [[nodiscard]] bool is_marked() const { return refusal.empty(); }
};

// Marks a mesh, whose coordinates are floats, as the request says. Throws Error Usage as resolve()
// does, and for fill, which carries no message. Takes as long as mark().
[[nodiscard]] TrialMark mark_for_trial(const Mesh& mesh, const MarkRequest& request,
                                       const Key& key);

// What a blind reader makes of an attacked mesh.
struct TrialReading {
  bool is_recovered = false;  // it finds the message that was hidden, and no other
  // The share of the bits of the message's parts whose value, as most units say, is wrong, or that
  // no unit reads. Random values are wrong in half of the bits, so more says only how much is
  // missing. Codes that correct errors bring messages back whose share is above 0.
  double wrong_bits = 1;
  double false_alarm = 0;  // probability that an unmarked mesh yields a message
};

// Reads a mesh that came of a marked one. The reader knows key, scheme and options, as one does who
// looks for his own mark, and nothing of the mesh or of what happened to it. O(triangles).
[[nodiscard]] TrialReading read_for_trial(const Mesh& mesh, const TrialMark& mark, const Key& key);

}  // namespace triglyph
