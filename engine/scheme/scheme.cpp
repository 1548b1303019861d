#include "engine/scheme/scheme.h"

#include "engine/base/error.h"
#include "engine/scheme/tsq.h"

namespace triglyph {

std::unique_ptr<Scheme> make_scheme(const std::string& name, const WordCode& code,
                                    const SchemeOptions& options) {
  if (name == "tsq") return std::make_unique<TsqScheme>(code, options);
  throw Error(ErrorCode::Usage, {}, "", "unknown scheme '" + name + "'");
}

}  // namespace triglyph
