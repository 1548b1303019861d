#include "engine/scheme/scheme.h"

#include <algorithm>
#include <array>

#include "engine/base/error.h"
#include "engine/mesh/edge_length.h"
#include "engine/scheme/aie/aie.h"
#include "engine/scheme/iie/iie.h"
#include "engine/scheme/tsq/tsq.h"

namespace triglyph {
namespace {

struct KnownScheme {
  SchemeDefaults (*defaults)();
  std::unique_ptr<Scheme> (*make)(const WordCode& code, const SchemeOptions& options);
};

template <typename Kind>
std::unique_ptr<Scheme> make(const WordCode& code, const SchemeOptions& options) {
  return std::make_unique<Kind>(code, options);
}

constexpr std::array<std::string_view, 3> kNames = {"tsq", "aie", "iie"};
constexpr std::array<KnownScheme, kNames.size()> kSchemes = {
    {{TsqScheme::defaults, make<TsqScheme>},
     {AieScheme::defaults, make<AieScheme>},
     {IieScheme::defaults, make<IieScheme>}}};

// by CostFunction
constexpr std::array<std::string_view, 4> kCostNames = {"displacement", "rms", "hausdorff",
                                                        "normal"};

const KnownScheme& scheme_named(const std::string& name) {
  const auto at = std::find(kNames.begin(), kNames.end(), name);
  if (at == kNames.end()) throw Error(ErrorCode::Usage, {}, "", "unknown scheme '" + name + "'");
  return kSchemes.at(static_cast<std::size_t>(at - kNames.begin()));
}

}  // namespace

std::span<const std::string_view> cost_names() {
  return kCostNames;
}

std::string_view name_of(CostFunction cost) {
  return kCostNames.at(static_cast<std::size_t>(cost));
}

CostFunction cost_function(const std::string& name) {
  const auto at = std::find(kCostNames.begin(), kCostNames.end(), name);
  if (at == kCostNames.end()) throw Error(ErrorCode::Usage, {}, "", "unknown cost '" + name + "'");
  return static_cast<CostFunction>(at - kCostNames.begin());
}

std::string_view name_of(AieGroups groups) {
  return groups == AieGroups::One ? "one" : "all";
}

AieGroups aie_groups(const std::string& name) {
  for (const AieGroups groups : {AieGroups::One, AieGroups::All}) {
    if (name == name_of(groups)) return groups;
  }
  throw Error(ErrorCode::Usage, {}, "", "unknown groups '" + name + "'");
}

std::span<const std::string_view> scheme_names() {
  return kNames;
}

SchemeDefaults scheme_defaults(const std::string& name) {
  return scheme_named(name).defaults();
}

SchemeOptions fixed_for(const Mesh& mesh, SchemeOptions options) {
  if (!(options.radius > 0)) options.radius = options.radius_edges * mean_edge_length(mesh);
  return options;
}

std::unique_ptr<Scheme> make_scheme(const std::string& name, const WordCode& code,
                                    const SchemeOptions& options) {
  return scheme_named(name).make(code, options);
}

}  // namespace triglyph
