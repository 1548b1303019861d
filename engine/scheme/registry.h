// The schemes by name. Code outside a scheme's folder knows its options only as values by key.
//
// To add a scheme, give it a folder with its options and its class, and add it to kNames and
// schemes() in registry.cpp and to the source lists of engine/scheme and tests/scheme.
#pragma once

#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "engine/base/options.h"
#include "engine/mesh/mesh.h"
#include "engine/scheme/scheme.h"
#include "engine/scheme/scheme_options.h"

namespace triglyph {

// The defaults of a scheme: for a message at some strength, or for the paper's experiment (--fill),
// in which every unit carries a part of its own and cells need only survive rounding.
struct SchemeDefaults {
  WordFormat format;              // with fill, its subscript bits are the most that are used
  OptionValues options;           // every option of the scheme
  std::uint32_t redundancy = 32;  // units wanted per part; 0: as many as there are
  CostFunction cost = CostFunction::Displacement;
  // Says whether units are scarce: it then pays to search long for more of them, and all are used,
  // even those that move farther.
  bool has_few_units = false;
};

struct SchemeInfo {
  std::string_view name;
  std::vector<OptionSpec> options;
  SchemeDefaults (*defaults)(bool fill, Strength strength);  // fill has one strength
  // Returns the defaults for a message of older generations, newest first; an option that only
  // newer ones know has the value that means the same.
  std::vector<SchemeDefaults> (*older)();
  // Makes the scheme; options that are not named take their defaults for a message. Throws Error
  // Usage for options out of range or a word that does not fit a unit.
  std::unique_ptr<Scheme> (*make)(const WordCode& code, const OptionValues& options,
                                  CostFunction cost);
};

// Returns the names of the schemes: "tsq" (invariant under similarities), "aie" (under affine
// maps), "iie" (robust against noise).
[[nodiscard]] std::span<const std::string_view> scheme_names();

// Returns what is known of a scheme. Throws Error Usage for an unknown name.
[[nodiscard]] const SchemeInfo& scheme_info(std::string_view name);

// Makes a scheme by name. Throws Error Usage for an unknown name, and as SchemeInfo::make does.
[[nodiscard]] std::unique_ptr<Scheme> make_scheme(std::string_view name, const WordCode& code,
                                                  const OptionValues& options,
                                                  CostFunction cost = CostFunction::Displacement);

// Returns a number among the values, or `otherwise`.
[[nodiscard]] double number_in(const OptionValues& values, std::string_view key, double otherwise);

// Returns the number of parts whose second best value a reader tries; 0 for schemes without that
// option.
[[nodiscard]] int doubtful_parts(const OptionValues& options);

// Says whether words carry parities of the message under these options of a scheme.
[[nodiscard]] bool is_spread(std::string_view scheme, const OptionValues& options);

// Returns the options with the sizes that are relative to the mesh made absolute, so that they
// mean the same for the marked mesh to the last bit. O(triangles).
[[nodiscard]] OptionValues fixed_for(const Mesh& mesh, OptionValues options);

}  // namespace triglyph
