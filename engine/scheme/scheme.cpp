#include "engine/scheme/scheme.h"

#include "engine/base/error.h"
#include "engine/scheme/tsq.h"

namespace triglyph {

std::string_view name_of(CostFunction cost) {
  return cost == CostFunction::Displacement ? "displacement" : "rms";
}

CostFunction cost_function(const std::string& name) {
  for (const CostFunction cost : {CostFunction::Displacement, CostFunction::Rms}) {
    if (name == name_of(cost)) return cost;
  }
  throw Error(ErrorCode::Usage, {}, "", "unknown cost '" + name + "'");
}

SchemeDefaults scheme_defaults(const std::string& name) {
  if (name == "tsq") return TsqScheme::defaults();
  throw Error(ErrorCode::Usage, {}, "", "unknown scheme '" + name + "'");
}

std::unique_ptr<Scheme> make_scheme(const std::string& name, const WordCode& code,
                                    const SchemeOptions& options) {
  if (name == "tsq") return std::make_unique<TsqScheme>(code, options);
  throw Error(ErrorCode::Usage, {}, "", "unknown scheme '" + name + "'");
}

}  // namespace triglyph
