#include "manifests/job.h"

namespace triglyph {

MarkOptions JobSettings::resolved() const {
  MarkOptions options = default_mark_options(scheme, fill);
  options.format.marker_bits = marker_bits.value_or(options.format.marker_bits);
  options.format.subscript_bits = subscript_bits.value_or(options.format.subscript_bits);
  options.format.part_bits = part_bits.value_or(options.format.part_bits);
  options.scheme_options.step = step.value_or(options.scheme_options.step);
  options.scheme_options.cost = cost;
  options.scheme_options.groups = groups;
  options.conflict_rule = conflict_rule;
  options.layout = layout;
  options.assign = assign;
  options.redundancy = redundancy;
  options.max_move_rel_diag = max_move_rel_diag;
  return options;
}

}  // namespace triglyph
