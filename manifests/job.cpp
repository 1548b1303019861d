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
  options.scheme_options.radius_edges = radius_edges.value_or(options.scheme_options.radius_edges);
  options.scheme_options.radius = radius.value_or(options.scheme_options.radius);
  options.scheme_options.site_rings = site_rings.value_or(options.scheme_options.site_rings);
  options.conflict_rule = conflict_rule;
  const LayoutMethod method = layout.value_or(options.layout.method);
  options.layout = layout_search;
  options.layout.method = method;
  options.assign = assign;
  options.redundancy = redundancy;
  options.max_move_rel_diag = max_move_rel_diag.value_or(options.max_move_rel_diag);
  options.drop_dearest = drop_dearest;
  options.keeps_subscript_bits = subscript_bits.has_value();
  return options;
}

}  // namespace triglyph
