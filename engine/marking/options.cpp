#include "engine/marking/options.h"

#include <algorithm>
#include <array>

#include "engine/base/error.h"
#include "engine/message/key.h"
#include "engine/scheme/registry.h"
#include "engine/trace/fingerprint_reading.h"

namespace triglyph {
namespace {

constexpr std::array<std::string_view, 3> kAssignNames = {"sequential", "bottleneck", "sum"};

// The forms of the payload; values may hold at most one of them.
constexpr std::array<std::string_view, 4> kMessageKeys = {"message", "message_hex", "recipient",
                                                          "fill"};

// Copies differ as little from the mesh as those that resist nobody: MSDM2 of the bunny is 0.034
// and 0.033.
constexpr std::uint32_t kUsualColluders = 2;

// by Carry
constexpr std::array<std::string_view, 3> kCarryNames = {"message", "any", "fingerprint"};

// A search longer than a day is taken for a typing error; seeds must be exact as JSON numbers.
constexpr double kMostSeconds = 86400;
constexpr double kMostSeed = 9007199254740992.0;  // 2^53

// A quarter of what marks of normal strength come to at worst.
constexpr double kLightVisibility = 0.05;

// by Strength
constexpr std::array<std::string_view, 3> kStrengthNames = {"light", "normal", "strong"};

constexpr std::string_view kAuto = "auto";
constexpr std::string_view kFluxPlus = "flux+";

// The scheme of the units of "auto", and of marks without a layer of units, whose options say
// nothing.
constexpr std::string_view kUsualUnits = "tsq";

OptionSpec scheme_spec() {
  std::vector<std::string> names = {std::string(kAuto), std::string(kFluxScheme)};
  for (const std::string_view scheme : scheme_names()) names.emplace_back(scheme);
  for (const std::string_view scheme : scheme_names()) {
    names.push_back(std::string(kFluxPlus) += scheme);
  }
  return {"scheme",
          OptionKind::Choice,
          "",
          {},
          names,
          Encoding{}.scheme,
          "Embedding scheme, or two in layers; auto: flux and tsq, what the mesh can carry"};
}

std::vector<OptionSpec> message_specs() {
  return {
      {"message", OptionKind::Text, "", {}, {}, "", "Message to hide, 1 to 256 bytes"},
      {"message_hex", OptionKind::Text, "", {}, {}, "", "Message in hexadecimal"},
      {"recipient",
       OptionKind::Text,
       "",
       {},
       {},
       "",
       "Name of whom the copy is for, 1 to 256 bytes: hides its fingerprint, which trace finds"},
      {"fill",
       OptionKind::Flag,
       "",
       {},
       {},
       "",
       "Hide a random message as long as the capacity, as in the paper's experiment"}};
}

using Options = MarkOptions;

// The numbers of bits are members of a member, so their accessors are written out.
Option<Options> bits_option(std::string key, int WordFormat::*bits, OptionRange range,
                            std::string help) {
  return {{std::move(key), OptionKind::Count, "bits", range, {}, "the scheme's", std::move(help)},
          [bits](Options& options, const OptionValue& value) {
            options.format.*bits = static_cast<int>(std::get<std::int64_t>(value));
            if (bits == &WordFormat::subscript_bits) options.keeps_subscript_bits = true;
          },
          [bits](const Options& options) {
            return std::optional<OptionValue>(std::int64_t{options.format.*bits});
          }};
}

// An option of the layout, which is a member of the options of marking.
Option<Options> of_layout(Option<LayoutOptions> option) {
  return {std::move(option.spec),
          [set = std::move(option.set)](Options& options, const OptionValue& value) {
            set(options.layout, value);
          },
          [get = std::move(option.get)](const Options& options) { return get(options.layout); }};
}

OptionTable<Options> make_table() {
  using Layout = LayoutOptions;
  return {
      bits_option("marker_bits", &WordFormat::marker_bits, {0, 16}, "Marker bits in a unit, m"),
      bits_option(
          "subscript_bits", &WordFormat::subscript_bits, {1, 16},
          "Subscript bits in a unit, s; with --fill, as few as number all units unless given"),
      bits_option("part_bits", &WordFormat::part_bits, {2, 32}, "Message bits in a unit, w"),
      choice_option<Options>("strength", &Options::strength, strength_names(), "normal",
                             "How much the mark may change the mesh, and survives"),
      choice_option<Options>(
          "carry", &Options::carry, kCarryNames, "any with auto, or else message",
          "What the mark carries: the message, or its fingerprint, which trace finds for whoever "
          "knows the message and which takes fewer units, or any of these, the first first"),
      count_option<Options>("collusion", &Options::collusion, {1, kMostColluders}, "copies", "2",
                            "Fingerprints name one of so many who combine their copies"),
      number_option<Options>("max_visibility", &Options::max_visibility, {0, 1}, "MSDM2",
                             "0.05 with --strength light, or else 0",
                             "Visibility that the mark keeps within; 0: by strength alone"),
      of_layout(choice_option<Layout>("layout", &Layout::method, layout_names(), "the scheme's",
                                      "Method that chooses the units; first-fit is un-optimised")),
      of_layout(count_option<Layout>("layout_iterations", &Layout::iterations, {1, 1e9}, "", "64",
                                     "Passes over the candidates, for layouts that search")),
      of_layout(number_option<Layout>(
          "layout_seconds", &Layout::seconds, {0, kMostSeconds}, "seconds", "0",
          "Time to search instead; the result then depends on the machine; 0: by passes")),
      of_layout(count_option<Layout>("layout_seed", &Layout::seed, {0, kMostSeed}, "", "1",
                                     "Seed of the search's random numbers")),
      choice_option<Options>(
          "conflicts", &Options::conflict_rule, conflict_names(), "read-write",
          "Units interfere if one moves a point that the other reads, or if they share any point"),
      choice_option<Options>(
          "assign", &Options::assign, assign_names(), "bottleneck",
          "Method that assigns words to units: in sequence (un-optimised), with the least maximum "
          "cost, or with the least sum of costs"),
      choice_option<Options>("cost", &Options::cost, cost_names(),
                             "displacement, or rms with --strength light",
                             "Local change of the surface that the assignment minimises"),
      count_option<Options>(
          "redundancy", &Options::redundancy, {0, 1e6}, "units", "the strength's: 8, 32, 0",
          "Units wanted for each part of the message; 0: as many as there are; iie uses "
          "all in its local encoding"),
      number_option<Options>("max_move", &Options::max_move_percent, {0, 100},
                             "percent of the diagonal", "",
                             "Farthest that a point may move; a mesh that cannot be marked so is "
                             "refused. Without it, parts get fewer units rather than move points "
                             "farther than 0.1, except with iie; 0: no limit"),
      number_option<Options>("drop_dearest", &Options::drop_dearest_percent, {0, 99.9}, "percent",
                             "0",
                             "Share of the candidates to leave out, the most expensive ones first: "
                             "lowers capacity and visibility"),
      count_option<Options>("digits", &Options::digits, {0, 8}, "digits", "",
                            "Digits more than the file's that moved coordinates of text formats "
                            "may have. Without it, none, or one where the file's are too few"),
      flag_option<Options>("remark", &Options::remark,
                           "Mark a mesh also if it carries a mark of this key already"),
      flag_option<Options>(
          "detail", &Options::detail,
          "List every unit in the record, for verify --detail; always on with iie")};
}

const OptionTable<Options>& table() {
  static const OptionTable<Options> options = make_table();
  return options;
}

// Returns the options of all schemes, each key once. A key that schemes share means the same in all
// of them; each scheme checks its own range.
std::vector<OptionSpec> scheme_specs() {
  std::vector<OptionSpec> specs;
  for (const std::string_view scheme : scheme_names()) {
    for (const OptionSpec& spec : scheme_info(scheme).options) {
      const auto same_key = [&](const OptionSpec& other) { return other.key == spec.key; };
      const auto known = std::find_if(specs.begin(), specs.end(), same_key);
      if (known == specs.end()) {
        specs.push_back(spec);
      } else {
        known->range.least = std::min(known->range.least, spec.range.least);
        known->range.most = std::max(known->range.most, spec.range.most);
      }
    }
  }
  return specs;
}

bool has_option(std::string_view name, std::string_view key) {
  const Layers layers = layers_named(name);
  if (layers.units == LayerUse::No) return false;
  const auto& options = scheme_info(layers.scheme).options;
  return std::any_of(options.begin(), options.end(),
                     [&](const OptionSpec& spec) { return spec.key == key; });
}

bool is_scheme_option(std::string_view key) {
  const auto names = scheme_names();
  return std::any_of(names.begin(), names.end(),
                     [&](std::string_view scheme) { return has_option(scheme, key); });
}

// The options of a scheme, with the numbers of bits.
OptionValues with_bits(const SchemeDefaults& defaults) {
  OptionValues values = defaults.options;
  values["marker_bits"] = std::int64_t{defaults.format.marker_bits};
  values["subscript_bits"] = std::int64_t{defaults.format.subscript_bits};
  values["part_bits"] = std::int64_t{defaults.format.part_bits};
  return values;
}

// Overrides the scheme's defaults, checked by the scheme's own declarations.
void apply_scheme_options(const OptionValues& values, MarkOptions& options) {
  for (const OptionSpec& spec : scheme_info(options.scheme).options) {
    const auto found = values.find(spec.key);
    if (found != values.end()) options.scheme_options[spec.key] = spec.checked(found->second);
  }
}

Strength strength_of(const OptionValues& values) {
  MarkOptions options;
  const auto found = values.find("strength");
  if (found != values.end()) apply_options(table(), {*found}, options);
  return options.strength;
}

// Returns the options of the values, by default those of a message of so many bytes.
MarkOptions resolved_options(const OptionValues& values, std::string_view name, bool fill,
                             std::size_t message_bytes) {
  const Strength strength = strength_of(values);
  MarkOptions options = default_mark_options(name, fill, strength);
  const WordFormat& format = options.format;
  if (!fill && !format.is_spread &&
      parts_for(format, message_bytes) > 1U << format.subscript_bits) {
    // what readers try for other strengths has room for any message
    const MarkOptions usual = default_mark_options(name, fill);
    options.format = usual.format;
    options.scheme_options = usual.scheme_options;
  }
  apply_options(table(), values, options);
  apply_scheme_options(values, options);
  options.format.is_spread = is_spread(options.scheme, options.scheme_options);
  if (fill && options.format.is_spread) {
    throw Error(ErrorCode::Usage, {}, "", "fill wants the global encoding of iie");
  }
  validate(options.format);
  options.keeps_subscript_bits = options.keeps_subscript_bits && fill;
  options.detail = options.detail || options.scheme == "iie";  // locating damage is its use
  // the constructor of a scheme checks its options in combination
  (void)make_scheme(options.scheme, WordCode(Key::trial(), options.format), options.scheme_options);
  return options;
}

void check_payload(const MarkRequest& request) {
  const MarkOptions& options = request.options;
  const std::size_t bytes = request.message().size();
  if (options.carry != Carry::Fingerprint) {
    check_message(options.format, bytes);
  } else if (bytes < kMinMessageBytes || bytes > kMaxMessageBytes) {
    throw Error(ErrorCode::Usage, {}, "",
                "a recipient's name has 1 to 256 bytes, not " + std::to_string(bytes));
  }
  if (options.carry == Carry::Fingerprint && options.format.part_bits > kMostFingerprintBits) {
    throw Error(ErrorCode::Usage, {}, "",
                "fingerprints take up to " + std::to_string(kMostFingerprintBits) + " part bits");
  }
  if (options.collusion > 1 && options.carry != Carry::Fingerprint) {
    throw Error(ErrorCode::Usage, {}, "",
                "collusion is of copies: it needs a recipient, or carry fingerprint");
  }
}

}  // namespace

std::span<const std::string_view> assign_names() {
  return kAssignNames;
}

std::string_view name_of(AssignMethod method) {
  return kAssignNames.at(static_cast<std::size_t>(method));
}

std::span<const std::string_view> strength_names() {
  return kStrengthNames;
}

Layers layers_named(std::string_view name) {
  if (name == kAuto) {
    return {LayerUse::IfPossible, LayerUse::IfPossible, std::string(kUsualUnits)};
  }
  if (name == kFluxScheme) return {LayerUse::Yes, LayerUse::No, std::string(kUsualUnits)};
  if (name.starts_with(kFluxPlus)) {
    return {LayerUse::Yes, LayerUse::Yes, std::string(name.substr(kFluxPlus.size()))};
  }
  return {LayerUse::No, LayerUse::Yes, std::string(name)};
}

std::string MarkOptions::scheme_name() const {
  if (flux == LayerUse::No) return scheme;
  if (flux == LayerUse::IfPossible) return std::string(kAuto);
  return units == LayerUse::No ? std::string(kFluxScheme) : std::string(kFluxPlus) + scheme;
}

MarkOptions default_mark_options(std::string_view name, bool fill, Strength strength) {
  const Layers layers = layers_named(name);
  const SchemeDefaults defaults = scheme_info(layers.scheme).defaults(fill, strength);
  MarkOptions options;
  options.scheme = layers.scheme;
  options.units = layers.units;
  options.flux = layers.flux;
  options.carry = layers.flux == LayerUse::IfPossible && !fill ? Carry::Any : Carry::Whole;
  options.strength = strength;
  options.format = defaults.format;
  options.scheme_options = defaults.options;
  options.redundancy = defaults.redundancy;
  options.cost = defaults.cost;
  if (strength == Strength::Light && !fill) options.max_visibility = kLightVisibility;
  if (defaults.has_few_units && !fill) {
    options.layout.method = LayoutMethod::LocalSearch;
  }
  return options;
}

const std::vector<OptionSpec>& mark_option_specs() {
  static const std::vector<OptionSpec> specs = [] {
    std::vector<OptionSpec> all = message_specs();
    all.push_back(scheme_spec());
    for (OptionSpec& spec : scheme_specs()) all.push_back(std::move(spec));
    for (const Option<Options>& option : table()) all.push_back(option.spec);
    return all;
  }();
  return specs;
}

const std::vector<OptionSpec>& encoding_option_specs() {
  static const std::vector<OptionSpec> specs = [] {
    std::vector<OptionSpec> some = {scheme_spec()};
    for (OptionSpec& spec : scheme_specs()) some.push_back(std::move(spec));
    for (const char* key : {"marker_bits", "subscript_bits", "part_bits"}) {
      some.push_back(find_option(table(), key)->spec);
    }
    some[0].default_text = "all";
    return some;
  }();
  return specs;
}

const OptionSpec* find_mark_option(std::string_view key) {
  for (const OptionSpec& spec : mark_option_specs()) {
    if (spec.key == key) return &spec;
  }
  return nullptr;
}

OptionValues layered(OptionValues base, const OptionValues& over) {
  const bool names_message =
      std::any_of(kMessageKeys.begin(), kMessageKeys.end(), [&](std::string_view key) {
        const auto found = over.find(key);
        return found != over.end() && found->second != OptionValue(false);
      });
  if (names_message) {
    for (const std::string_view key : kMessageKeys) base.erase(std::string(key));
  }
  for (const auto& [key, value] : over) base.insert_or_assign(key, value);
  return base;
}

void check_contradictions(const OptionValues& values, std::string_view scheme) {
  std::string_view message_key;
  for (const std::string_view key : kMessageKeys) {
    const auto found = values.find(key);
    if (found == values.end() || found->second == OptionValue(false)) continue;
    if (!message_key.empty()) {
      throw Error(ErrorCode::Usage, {}, "",
                  "\"" + std::string(message_key) + "\" and \"" + std::string(key) +
                      "\" exclude each other");
    }
    message_key = key;
  }
  for (const auto& [key, value] : values) {
    if (!scheme.empty() && is_scheme_option(key) && !has_option(scheme, key)) {
      throw Error(ErrorCode::Usage, {}, "",
                  "\"" + key + "\" is no option of scheme " + std::string(scheme));
    }
  }
}

std::string scheme_of(const OptionValues& values) {
  const auto found = values.find("scheme");
  return found == values.end() ? std::string(kAuto)
                               : std::get<std::string>(scheme_spec().checked(found->second));
}

MarkRequest resolve(const OptionValues& values) {
  MarkRequest request;
  const auto text_of = [&](std::string_view key) -> const std::string* {
    const auto found = values.find(key);
    return found == values.end() ? nullptr : std::get_if<std::string>(&found->second);
  };
  const auto fill = values.find("fill");
  if (fill != values.end() && fill->second == OptionValue(true)) {
    request.payload = Fill{};
  } else if (const std::string* hex = text_of("message_hex")) {
    request.payload = from_hex(*hex);
  } else if (const std::string* text = text_of("message")) {
    request.payload = Message(text->begin(), text->end());
  } else if (const std::string* name = text_of("recipient")) {
    request.payload = Message(name->begin(), name->end());
  } else {
    throw Error(ErrorCode::Usage, {}, "",
                "no message: give --message, --message-hex, --recipient or --fill");
  }
  const bool is_copy = text_of("recipient") != nullptr;
  const auto carry = values.find("carry");
  const bool is_fingerprint = is_copy || (carry != values.end() &&
                                          carry->second == OptionValue(std::string("fingerprint")));
  // what a fingerprint takes does not depend on the length of its name
  const std::size_t bytes = request.is_fill() ? 0
                            : is_fingerprint  ? kMinMessageBytes
                                              : request.message().size();
  request.options = resolved_options(values, scheme_of(values), request.is_fill(), bytes);
  if (is_copy) request.options.carry = Carry::Fingerprint;
  if (is_copy && !values.contains("collusion")) request.options.collusion = kUsualColluders;
  if (request.is_fill() && request.options.flux == LayerUse::Yes) {
    throw Error(ErrorCode::Usage, {}, "",
                "the flux layer carries a message or its number: --fill needs a scheme of units");
  }
  if (request.is_fill()) request.options.flux = LayerUse::No;
  if (!request.is_fill()) check_payload(request);
  return request;
}

std::vector<Encoding> encodings_of(const OptionValues& values) {
  const bool is_named = values.contains("scheme");
  const Layers named = layers_named(is_named ? scheme_of(values) : kAuto);
  std::vector<Encoding> encodings;
  for (const std::string_view scheme : scheme_names()) {
    const bool is_wanted = !is_named || (named.units != LayerUse::No && named.scheme == scheme);
    if (is_wanted) {
      const SchemeInfo& info = scheme_info(scheme);
      std::vector<SchemeDefaults> tried = {info.defaults(false, Strength::Normal)};
      for (SchemeDefaults& older : info.older()) tried.push_back(std::move(older));
      tried.push_back(info.defaults(false, Strength::Strong));
      for (const SchemeDefaults& defaults : tried) {
        const OptionValues all = layered(with_bits(defaults), values);
        Encoding encoding = resolved_options(all, scheme, false, kMinMessageBytes).encoding();
        const auto same = std::find(encodings.begin(), encodings.end(), encoding);
        if (same == encodings.end()) encodings.push_back(std::move(encoding));
      }
    }
    // behind the scheme that is the quickest to read
    const bool is_place = scheme == scheme_names().front();
    if (is_place && named.flux != LayerUse::No) {
      encodings.push_back({std::string(kFluxScheme), {}, {}});
    }
  }
  return encodings;
}

OptionValues values_of(const MarkOptions& options) {
  OptionValues values = option_values(table(), options);
  values.emplace("scheme", options.scheme_name());
  for (const auto& [key, value] : options.scheme_options) values.emplace(key, value);
  return values;
}

}  // namespace triglyph
