// The options of marking. Each is declared once, in options.cpp or beside its scheme; command line,
// config files, manifests, records and help read these declarations.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "engine/base/options.h"
#include "engine/layout/layout.h"
#include "engine/message/words.h"
#include "engine/scheme/encoding.h"
#include "engine/scheme/scheme.h"
#include "engine/scheme/scheme_options.h"

namespace triglyph {

enum class AssignMethod {
  Sequential,  // un-optimised: the i-th unit carries the i-th word
  Bottleneck,  // least maximum of the costs, then least sum (the paper's equation 3)
  Sum,         // least sum of the costs (equation 2)
};

// Returns the names in the order of AssignMethod: "sequential", "bottleneck", "sum".
[[nodiscard]] std::span<const std::string_view> assign_names();
[[nodiscard]] std::string_view name_of(AssignMethod method);

// Whether a mark has a layer.
enum class LayerUse : std::uint8_t {
  No,
  Yes,         // a mesh that cannot carry it is refused
  IfPossible,  // a mesh that can carry any layer is marked
};

// The layers of a mark by the name of its scheme: "tsq", "flux", "flux+tsq", or "auto", which is
// flux and tsq where they are possible.
struct Layers {
  LayerUse flux = LayerUse::No;
  LayerUse units = LayerUse::Yes;
  std::string scheme = "tsq";  // of the units
};
[[nodiscard]] Layers layers_named(std::string_view name);

// Returns the names by Strength: "light", "normal", "strong".
[[nodiscard]] std::span<const std::string_view> strength_names();

// What a mark carries of a message.
enum class Carry : std::uint8_t {
  Whole,        // all of it, to be read by whoever has the key
  Any,          // likewise, or where it does not fit its fingerprint
  Fingerprint,  // the fingerprint of it alone, to be found by whoever has the key and the message
};

struct MarkOptions {
  std::string scheme = "tsq";  // of the layer of units
  LayerUse units = LayerUse::Yes;
  LayerUse flux = LayerUse::No;
  Strength strength = Strength::Normal;
  Carry carry = Carry::Whole;
  // Fingerprints name one of so many that combine their copies.
  std::uint32_t collusion = 1;
  // Every layer moves the surface less where MSDM2 of the whole mark would exceed this; 0: no
  // limit.
  double max_visibility = 0;
  WordFormat format;
  OptionValues scheme_options;
  ConflictRule conflict_rule = ConflictRule::ReadWrite;
  CostFunction cost = CostFunction::Displacement;
  LayoutOptions layout;
  AssignMethod assign = AssignMethod::Bottleneck;
  // Units wanted per part; 0: as many as there are.
  std::uint32_t redundancy = 32;
  // No point moves farther than this, in percent of the surface's diagonal: parts get fewer units,
  // fill leaves units out, and a mesh that cannot be marked so is too visible. 0: no limit.
  // Nothing: parts get fewer units, down to kMinRedundancy, until no point moves farther than
  // kUsualMove, and only a move kVisibleMove times as far is never made; unless the scheme has few
  // units, the assignment is sequential, or the mesh is filled.
  std::optional<double> max_move_percent;
  // The share of the candidates to leave out, in percent: those whose cheapest word costs most.
  // This reduces the capacity and makes the mark less visible, since the least cost of a unit
  // bounds the bottleneck from below (in TSQ, the cost of the marker).
  double drop_dearest_percent = 0;
  // Fill uses format.subscript_bits unchanged instead of as few as tell the units apart.
  bool keeps_subscript_bits = false;
  // Marks a mesh also if it carries a mark of this key, scheme and word format. Fill never asks.
  bool remark = false;
  // Digits more than the file's that moved coordinates of text files may have. Nothing: none, or
  // one where the file's are too few for the mark.
  std::optional<int> digits;
  bool detail = false;  // reports every unit, so that verification can locate damage

  [[nodiscard]] Encoding encoding() const { return {scheme, format, scheme_options}; }
  // Returns the name of the scheme with its layers, the inverse of layers_named().
  [[nodiscard]] std::string scheme_name() const;
  bool operator==(const MarkOptions&) const = default;
};

// Returns the default options of a scheme, by its name with layers, for a message, or for fill,
// which has no flux layer and one strength. Throws Error Usage for an unknown scheme.
[[nodiscard]] MarkOptions default_mark_options(std::string_view scheme, bool fill,
                                               Strength strength = Strength::Normal);

// Returns all options of marking in the order of help and records: the payload ("message",
// "message_hex", "fill"), the scheme, the options of all schemes, layout, assignment.
[[nodiscard]] const std::vector<OptionSpec>& mark_option_specs();

// Returns the options that a reader needs for a mark that was not made with its scheme's defaults.
[[nodiscard]] const std::vector<OptionSpec>& encoding_option_specs();

// Returns the declaration of an option of marking, or null for an unknown key.
[[nodiscard]] const OptionSpec* find_mark_option(std::string_view key);

// The payload of the paper's experiment: random bits that the key determines, as many as the mesh
// can carry. Every unit carries a part of its own as far as the subscript bits number the units;
// beyond that, parts are repeated.
struct Fill {
  bool operator==(const Fill&) const = default;
};

// What a mark carries: a message of 1 to 256 bytes, or fill.
using Payload = std::variant<Message, Fill>;

// What one mesh is to carry, and how.
struct MarkRequest {
  Payload payload;
  MarkOptions options;

  [[nodiscard]] bool is_fill() const { return std::holds_alternative<Fill>(payload); }
  // Precondition: not fill.
  [[nodiscard]] const Message& message() const { return std::get<Message>(payload); }

  bool operator==(const MarkRequest&) const = default;
};

// Returns `base` overridden by the values of `over`. A payload in any of its three forms replaces
// one in any form.
[[nodiscard]] OptionValues layered(OptionValues base, const OptionValues& over);

// Throws Error Usage if the values contradict each other: two forms of the payload, or an option
// that `scheme` does not have but another scheme has. An empty `scheme` allows those of any.
void check_contradictions(const OptionValues& values, std::string_view scheme);

// Returns the scheme that the values name, or the default scheme. Throws Error Usage for an unknown
// one.
[[nodiscard]] std::string scheme_of(const OptionValues& values);

// Returns the request that the values describe; options of other schemes are ignored. Throws Error
// Usage for values out of range, an unknown scheme, a missing or empty message, or one that does
// not fit the word format.
[[nodiscard]] MarkRequest resolve(const OptionValues& values);

// Returns the encodings that a reader tries for these values: that of the scheme they name, or one
// of every scheme, with defaults for options that have no value. Throws Error Usage as resolve()
// does.
[[nodiscard]] std::vector<Encoding> encodings_of(const OptionValues& values);

// Returns the values of all options, including the scheme and its options. resolve() of these
// values and of a message returns the same options.
[[nodiscard]] OptionValues values_of(const MarkOptions& options);

}  // namespace triglyph
