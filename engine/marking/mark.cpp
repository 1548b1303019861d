#include "engine/marking/mark.h"

#include <utility>
#include <variant>

#include "engine/marking/mark_stages.h"
#include "engine/marking/way_out.h"

namespace triglyph {
namespace {

Marking already_marked(Marking& marking, Extraction& before) {
  marking.status = MarkStatus::AlreadyMarked;
  marking.found = {std::move(*before.message), before.agreeing};
  return std::move(marking);
}

}  // namespace

Marking mark(const Surface& surface, const Payload& payload, const Key& key,
             const MarkOptions& options, const Rounding& rounding, double number_step) {
  validate(options.format);
  const auto* message = std::get_if<Message>(&payload);
  if (message != nullptr) check_message(options.format, message->size());
  const MarkTask task{surface, payload, key, options, {rounding, number_step}};
  MarkStages stages(task);
  if (message != nullptr && !options.remark) {
    Extraction before = stages.read();
    if (before.message) return already_marked(stages.marking(), before);
  }
  stages.select_units();
  Marking& marking = stages.marking();
  marking.status = MarkStatus::TooSmall;
  if (stages.make_words()) {
    stages.embed_words();
    marking.status = stages.status_of(marking);
  }
  if (marking.status == MarkStatus::TooCoarse) {
    marking.way_out = way_out_of_too_coarse(task);
  } else if (marking.status == MarkStatus::TooSmall) {
    marking.way_out = way_out_of_too_small(task, stages);
    const bool has_cap = options.max_move_percent.value_or(0) > 0;
    if (has_cap && marking.way_out.max_move_percent > 0) marking.status = MarkStatus::TooVisible;
  }
  return std::move(marking);
}

}  // namespace triglyph
