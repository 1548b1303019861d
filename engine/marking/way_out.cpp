#include "engine/marking/way_out.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include "engine/base/stop.h"
#include "engine/scheme/registry.h"

namespace triglyph {
namespace {

// A limit of moves that failed is raised by this factor: little, so that the least that does is
// found to a tenth.
constexpr double kRaiseMove = 1.1;
constexpr double kMostPercent = 100;  // of the option for the limit of moves

// A cell width that failed is raised by this factor: a few trials span the range of the option.
constexpr double kRaiseStep = 1.5;

// Looks for a beginning of the message that the mesh carries, such that one byte more is too much:
// in steps of a quarter, then by bisection. note: a beginning has another tag, hence other words,
// so that a longer one may fit by luck.
void find_length(const MarkTask& task, const Message& message, MarkStages& stages,
                 WayOut& way_out) {
  const auto fits = [&](std::size_t bytes) {
    stop_point();
    const Marking trial = stages.marked_with(std::span<const std::uint8_t>(message).first(bytes));
    if (trial.status != MarkStatus::Marked) way_out.least_parts_carried = trial.parts_carried;
    return trial.status == MarkStatus::Marked;
  };
  std::size_t too_many = message.size();
  const std::uint32_t units = stages.marking().units_valid;
  while (too_many > 1 && least_units_for(task.options.format, too_many - 1) > units) --too_many;
  std::size_t bytes = too_many - 1;
  while (bytes > 0 && !fits(bytes)) {
    too_many = bytes;
    bytes = bytes * 3 / 4;
  }
  while (bytes > 0 && too_many - bytes > 1) {
    const std::size_t middle = bytes + (too_many - bytes) / 2;
    (fits(middle) ? bytes : too_many) = middle;
  }
  way_out.message_bytes = bytes;
}

// Looks for the least limit of moves, to two digits, within which the mesh can be marked.
void find_max_move(MarkStages& stages, WayOut& way_out) {
  const double needed = stages.least_move_percent();
  if (!(needed > 0 && needed < kMostPercent)) return;
  double percent = rounded_up(needed);
  while (stages.marked_within(percent).status != MarkStatus::Marked) {
    stop_point();
    percent = rounded_up(kRaiseMove * percent);
    if (percent > kMostPercent) return;
  }
  way_out.move_needed_percent = needed;
  way_out.max_move_percent = percent;
}

double widest_step(const std::string& scheme) {
  const auto& options = scheme_info(scheme).options;
  const auto step = std::find_if(options.begin(), options.end(),
                                 [](const OptionSpec& spec) { return spec.key == "step"; });
  return step == options.end() ? 0 : step->range.most;
}

}  // namespace

double rounded_up(double value) {
  const int digits = 1 - static_cast<int>(std::floor(std::log10(value)));
  const double power = std::pow(10.0, std::abs(digits));
  const double count = std::ceil(digits >= 0 ? value * power : value / power);
  return digits >= 0 ? count / power : count * power;
}

WayOut way_out_of_too_small(const MarkTask& task, MarkStages& stages) {
  WayOut way_out;
  const Marking& marking = stages.marking();
  const bool has_units = !marking.words.empty() && marking.units_valid >= marking.parts_needed;
  const bool has_cap = task.options.max_move_percent.value_or(0) > 0;
  // a spread message needs no part in particular, and so no move
  const bool needs_moves = !task.options.format.is_spread && stages.is_limited();
  if (has_units && needs_moves) find_max_move(stages, way_out);
  if (has_cap && way_out.max_move_percent > 0) return way_out;
  if (const auto* message = std::get_if<Message>(&task.payload)) {
    find_length(task, *message, stages, way_out);
  }
  return way_out;
}

WayOut way_out_of_too_coarse(const MarkTask& task) {
  WayOut way_out;
  const double most = widest_step(task.options.scheme);
  MarkOptions options = task.options;
  const OptionValues defaults =
      scheme_info(options.scheme).defaults(false, options.strength).options;
  double step = number_in(options.scheme_options, "step", number_in(defaults, "step", most));
  const MarkTask wider{task.surface, task.payload, task.key, options, task.output};
  for (;;) {
    step = rounded_up(kRaiseStep * step);
    if (step > most) break;
    options.scheme_options["step"] = step;
    MarkStages stages(wider);
    stages.select_units();
    if (!stages.make_words()) break;
    stages.embed_words();
    if (stages.status_of(stages.marking()) != MarkStatus::Marked) continue;
    way_out.step = step;
    break;
  }
  return way_out;
}

}  // namespace triglyph
