// Attacks by name: what happens to meshes on their way, on purpose or not, as text that commands,
// tables and records share. "noise:0.3" is one attack with its parameter, and
// "simplify:50+noise:0.1" does one after the other.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/mesh/mesh.h"

namespace triglyph {

// The number behind the colon.
struct AttackParameter {
  std::string_view meaning;  // "percent of the triangles to remove"
  double least = 0;
  double most = 0;
  bool is_whole = false;
  std::optional<double> usual;  // where the number is left out; nothing: it must be given
};

// A kind of attack. Percentages become shares when it is applied.
struct AttackKind {
  std::string_view name;
  std::string_view help;  // what it does, a verb phrase
  std::optional<AttackParameter> parameter;
  bool draws_lots = false;  // depends on the seed
  Mesh (*apply)(const Mesh& mesh, double number, std::uint64_t seed) = nullptr;
};

// Returns all kinds, in the order of help and documentation.
[[nodiscard]] std::span<const AttackKind> attack_kinds();

// One attack, or several in a row.
class Attack {
 public:
  // Reads an attack as users name it: NAME, NAME:NUMBER, or several joined by '+'. Throws Error
  // Usage that names the attack, says what is wrong with it and what is allowed, and for an unknown
  // name which one may be meant.
  [[nodiscard]] static Attack parsed(std::string_view text);

  // Returns the attack in its shortest form, such that equal attacks have equal texts.
  [[nodiscard]] std::string text() const;

  // Says whether the result depends on the seed.
  [[nodiscard]] bool draws_lots() const;

  // Returns the attacked mesh, a function of mesh and seed alone, for any number of threads. Points
  // may lie at equal coordinates: see stored(). Throws Error Unsupported for a mesh that is too
  // large for the attack.
  [[nodiscard]] Mesh applied(const Mesh& mesh, std::uint64_t seed) const;

 private:
  struct Step {
    const AttackKind* kind;
    double number;
  };
  std::vector<Step> steps_;  // at least one
};

// Returns the names of the protocols: "benchmark", "leaks", "all".
[[nodiscard]] std::span<const std::string_view> protocol_names();

// Returns the attacks of a protocol: those of the benchmark with its strengths; what files go
// through that are copied, converted and printed; or both, without repeats. Throws Error Usage for
// an unknown name.
// Wang, Lavoue, Denis, Baskurt, He. A benchmark for 3D mesh watermarking. SMI (2010).
[[nodiscard]] std::vector<Attack> protocol(std::string_view name);

}  // namespace triglyph
