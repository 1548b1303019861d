// What marking can be told. Every option is declared once, in options.cpp or beside its scheme;
// command line, config files, manifests, records and help read these declarations.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/options.h"
#include "engine/layout/layout.h"
#include "engine/message/words.h"
#include "engine/scheme/scheme.h"
#include "engine/scheme/scheme_options.h"

namespace triglyph {

enum class AssignMethod {
  Sequential,  // un-optimised: the i-th unit carries the i-th word
  Bottleneck,  // least maximum of the costs, and of those the least sum (the paper's eq. 3)
  Sum,         // least sum of the costs (eq. 2)
};

// Names by AssignMethod: "sequential", "bottleneck", "sum".
[[nodiscard]] std::span<const std::string_view> assign_names();
[[nodiscard]] std::string_view name_of(AssignMethod method);

// How a mark is written into a mesh: what a reader must know beside the key.
struct Encoding {
  std::string scheme = "tsq";
  WordFormat format;
  OptionValues scheme_options;  // every option of the scheme with the value that applies

  bool operator==(const Encoding&) const = default;
};

struct MarkOptions {
  std::string scheme = "tsq";
  WordFormat format;
  OptionValues scheme_options;
  ConflictRule conflict_rule = ConflictRule::ReadWrite;
  CostFunction cost = CostFunction::Displacement;
  LayoutOptions layout;
  AssignMethod assign = AssignMethod::Bottleneck;
  std::uint32_t redundancy = 32;  // wanted units a part; 0: as many as there are
  // A unit that would move a point farther than this, in percent of the bounding box's diagonal, is
  // used only if its part has fewer than kMinRedundancy others, and never if it is ten times as
  // far. 0: no limit. Does not apply to sequential assignment nor to fill.
  double max_move_percent = 0.1;
  // Percent of the candidates that are left out: those whose cheapest word costs most. Less
  // capacity, and a less visible mark, since a unit that is dear under every word is a floor of
  // the bottleneck that no assignment gets below (TSQ: the marker's own cost).
  double drop_dearest_percent = 0;
  // Fill uses format.subscript_bits as they are, instead of as few as tell the units apart.
  bool keeps_subscript_bits = false;
  bool detail = false;  // keeps every unit, so that a reader can say which are damaged

  [[nodiscard]] Encoding encoding() const { return {scheme, format, scheme_options}; }
  bool operator==(const MarkOptions&) const = default;
};

// Returns the options with which a scheme marks a message, or fills a mesh, unless the user says
// otherwise. Throws Error Usage for an unknown scheme.
[[nodiscard]] MarkOptions default_mark_options(std::string_view scheme, bool fill);

// Every option of marking in the order of help and records: the message ("message",
// "message_hex", "fill"), the scheme and its options, layout, assignment.
[[nodiscard]] const std::vector<OptionSpec>& mark_option_specs();

// Those that a reader needs if a mark was not made with its scheme's defaults.
[[nodiscard]] const std::vector<OptionSpec>& encoding_option_specs();

// Returns null for an unknown key.
[[nodiscard]] const OptionSpec* find_mark_option(std::string_view key);

// What one mesh is to carry, and how.
struct MarkRequest {
  Message message;    // 1 to 256 bytes; empty for fill
  bool fill = false;  // the paper's experiment: a random message as long as the capacity
  MarkOptions options;

  bool operator==(const MarkRequest&) const = default;
};

// Returns `base` with the values of `over` in their places; a message in any of its three forms
// replaces one in any form.
[[nodiscard]] OptionValues layered(OptionValues base, const OptionValues& over);

// Throws Error Usage if the values contradict each other: two forms of the message, or an option
// that only other schemes than `scheme` have. An empty `scheme` stands for any.
void check_contradictions(const OptionValues& values, std::string_view scheme);

// Returns the scheme that the values name, or the default one.
[[nodiscard]] std::string scheme_of(const OptionValues& values);

// Turns values into a request; options of schemes other than the one in use do not count. Throws
// Error Usage for values out of range, an unknown scheme, no message, or a message that does not
// fit the word format.
[[nodiscard]] MarkRequest resolve(const OptionValues& values);

// Returns the encodings that these values can mean to a reader: that of the scheme they name, or
// those of every scheme, each with its defaults where the values say nothing. Throws Error Usage as
// resolve() does.
[[nodiscard]] std::vector<Encoding> encodings_of(const OptionValues& values);

// Returns all values that apply, the scheme's among them; resolve() of them and of the message
// gives the options again.
[[nodiscard]] OptionValues values_of(const MarkOptions& options);

}  // namespace triglyph
