#include "engine/scheme/registry.h"

#include <algorithm>
#include <array>

#include "engine/base/error.h"
#include "engine/mesh/edge_length.h"
#include "engine/scheme/aie/aie.h"
#include "engine/scheme/iie/iie.h"
#include "engine/scheme/iie/local_iie.h"
#include "engine/scheme/tsq/tsq.h"

namespace triglyph {
namespace {

// by CostFunction
constexpr std::array<std::string_view, 4> kCostNames = {"displacement", "rms", "hausdorff",
                                                        "normal"};

template <typename Options>
const OptionTable<Options>& table_of() {
  static const OptionTable<Options> table = Options::table();
  return table;
}

// Units wanted per part of a light mark. Among them are the cheapest by the mean square of the
// moves: MSDM2 is 0.4 times that of the usual 32 in the median.
constexpr std::uint32_t kLightRedundancy = 8;

template <typename Options>
SchemeDefaults defaults_of(bool fill, Strength strength) {
  SchemeDefaults defaults{.format = Options::format(fill),
                          .options = option_values(table_of<Options>(), Options::defaults(fill)),
                          .has_few_units = Options::kHasFewUnits};
  if (fill || strength == Strength::Normal) return defaults;
  if (strength == Strength::Light) {
    defaults.redundancy = kLightRedundancy;
    defaults.cost = CostFunction::Rms;
    return defaults;
  }
  defaults.format = Options::kStrongFormat;
  defaults.options = option_values(table_of<Options>(), Options::strong());
  defaults.redundancy = 0;
  return defaults;
}

template <typename Kind, typename Options>
std::unique_ptr<Scheme> make(const WordCode& code, const OptionValues& values, CostFunction cost) {
  Options options = Options::defaults(false);
  apply_options(table_of<Options>(), values, options);
  options.cost = cost;
  return std::make_unique<Kind>(code, options);
}

std::unique_ptr<Scheme> make_iie(const WordCode& code, const OptionValues& values,
                                 CostFunction cost) {
  IieOptions options = IieOptions::defaults(false);
  apply_options(table_of<IieOptions>(), values, options);
  options.cost = cost;
  if (options.encoding == IieEncoding::Global) return std::make_unique<IieScheme>(code, options);
  return std::make_unique<LocalIieScheme>(code, options);
}

std::vector<SchemeDefaults> none_older() {
  return {};
}

std::vector<SchemeDefaults> older_iie() {
  return {{.format = IieOptions::kFirstFormat,
           .options = option_values(table_of<IieOptions>(), IieOptions::first_generation()),
           .has_few_units = IieOptions::kHasFewUnits}};
}

template <typename Options>
SchemeInfo info_of(std::string_view name, decltype(SchemeInfo::make) make,
                   decltype(SchemeInfo::older) older = none_older) {
  SchemeInfo info{name, {}, defaults_of<Options>, older, make};
  for (const Option<Options>& option : table_of<Options>()) info.options.push_back(option.spec);
  return info;
}

// In the order in which a reader that is told nothing tries them: the surest answers first.
constexpr std::array<std::string_view, 3> kNames = {"tsq", "aie", "iie"};

const std::array<SchemeInfo, kNames.size()>& schemes() {
  static const std::array<SchemeInfo, kNames.size()> all = {
      info_of<TsqOptions>(kNames[0], make<TsqScheme, TsqOptions>),
      info_of<AieOptions>(kNames[1], make<AieScheme, AieOptions>),
      info_of<IieOptions>(kNames[2], make_iie, older_iie)};
  return all;
}

}  // namespace

std::span<const std::string_view> cost_names() {
  return kCostNames;
}

std::string_view name_of(CostFunction cost) {
  return kCostNames.at(static_cast<std::size_t>(cost));
}

std::span<const std::string_view> scheme_names() {
  return kNames;
}

const SchemeInfo& scheme_info(std::string_view name) {
  for (const SchemeInfo& scheme : schemes()) {
    if (scheme.name == name) return scheme;
  }
  throw Error(ErrorCode::Usage, {}, "", "unknown scheme '" + std::string(name) + "'");
}

std::unique_ptr<Scheme> make_scheme(std::string_view name, const WordCode& code,
                                    const OptionValues& options, CostFunction cost) {
  return scheme_info(name).make(code, options, cost);
}

double number_in(const OptionValues& values, std::string_view key, double otherwise) {
  const auto found = values.find(key);
  if (found == values.end()) return otherwise;
  if (const auto* count = std::get_if<std::int64_t>(&found->second)) {
    return static_cast<double>(*count);
  }
  const auto* number = std::get_if<double>(&found->second);
  return number != nullptr ? *number : otherwise;
}

int doubtful_parts(const OptionValues& options) {
  return static_cast<int>(number_in(options, "doubtful_parts", 0));
}

bool is_spread(std::string_view scheme, const OptionValues& options) {
  const auto encoding = options.find("iie_encoding");
  return scheme == "iie" && encoding != options.end() &&
         encoding->second == OptionValue(std::string(kIieEncodingNames[1]));
}

OptionValues fixed_for(const Mesh& mesh, OptionValues options) {
  const auto radius = options.find("radius");
  if (radius == options.end() || number_in(options, "radius", 0) > 0) return options;
  radius->second = number_in(options, "radius_edges", 0) * mean_edge_length(mesh);
  return options;
}

}  // namespace triglyph
