#include "engine/marking/marking.h"

#include "engine/base/error.h"

namespace triglyph {

std::string_view name_of(AssignMethod method) {
  switch (method) {
    case AssignMethod::Sequential:
      return "sequential";
    case AssignMethod::Bottleneck:
      return "bottleneck";
    case AssignMethod::Sum:
      return "sum";
  }
  return "";
}

AssignMethod assign_method(const std::string& name) {
  for (const AssignMethod method :
       {AssignMethod::Sequential, AssignMethod::Bottleneck, AssignMethod::Sum}) {
    if (name == name_of(method)) return method;
  }
  throw Error(ErrorCode::Usage, {}, "", "unknown assignment '" + name + "'");
}

MarkOptions default_mark_options(const std::string& scheme, bool fill) {
  const SchemeDefaults defaults = scheme_defaults(scheme);
  MarkOptions options;
  options.scheme = scheme;
  options.format = fill ? defaults.fill_format : defaults.format;
  options.scheme_options = fill ? defaults.fill_options : defaults.options;
  if (defaults.has_few_units && !fill) {
    options.layout.method = LayoutMethod::LocalSearch;
    options.max_move_rel_diag = 0;
  }
  return options;
}

}  // namespace triglyph
