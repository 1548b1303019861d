#include "engine/marking/mark.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <variant>

#include "engine/base/stop.h"
#include "engine/marking/plan_words.h"
#include "engine/marking/select_units.h"
#include "engine/marking/settle.h"
#include "engine/mesh/surface_diagonal.h"
#include "engine/scheme/registry.h"

namespace triglyph {
namespace {

// How often placements that failed are ruled out and the words assigned anew before the mark is
// taken as it is.
constexpr int kMaxRounds = 16;

// Share of a cell's width from which on the distance between the output's numbers explains that
// most units were lost: rounding moves each of a unit's points by up to half that distance, which
// leaves no margin.
constexpr double kCoarseStep = 0.05;

// A limit of moves that failed is raised by this factor: little, so that the least that does is
// found to a tenth.
constexpr double kRaise = 1.1;
constexpr double kMostPercent = 100;  // of the option for the limit of moves

// Returns the number of bits that tell the units apart, at most those of the format.
int fill_subscript_bits(std::size_t units, const WordFormat& format) {
  return std::clamp(static_cast<int>(std::bit_width(units - 1)), 1, format.subscript_bits);
}

// Returns the placements without a carrier, or none if every part kept at least half of its units.
std::vector<Placement> lost_placements(std::span<const Placement> placements, const UnitSet& units,
                                       const Marking& marking) {
  std::vector<std::uint32_t> placed(marking.words.size(), 0);
  std::vector<std::uint32_t> carried(marking.words.size(), 0);
  for (const Carrier& carrier : marking.carriers) ++carried[carrier.word];
  std::vector<Placement> lost;
  auto carrier = marking.carriers.begin();
  for (const Placement& placement : placements) {
    ++placed[placement.word];
    const bool is_carrier =
        carrier != marking.carriers.end() && carrier->anchor == units.anchors[placement.unit];
    if (is_carrier) {
      ++carrier;
    } else {
      lost.push_back(placement);
    }
  }
  for (std::size_t word = 0; word < placed.size(); ++word) {
    if (2 * carried[word] < std::max(placed[word], 1U)) return lost;
  }
  return {};
}

std::uint32_t count_parts(const Marking& marking) {
  std::vector<char> is_carried(marking.words.size(), 0);
  for (const Carrier& carrier : marking.carriers) is_carried[carrier.word] = 1;
  return static_cast<std::uint32_t>(std::count(is_carried.begin(), is_carried.end(), 1));
}

// Returns the value, above 0, rounded up to two significant digits: the double that these digits
// are read as.
double rounded_up(double value) {
  const int digits = 1 - static_cast<int>(std::floor(std::log10(value)));
  const double power = std::pow(10.0, std::abs(digits));
  const double count = std::ceil(digits >= 0 ? value * power : value / power);
  return digits >= 0 ? count / power : count * power;
}

class Stopwatch {
 public:
  // Returns the seconds since the last lap, or since construction.
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - start_).count();
    start_ = now;
    return seconds;
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// A scheme for words of one format, bound to a surface.
struct Binding {
  Binding(const Surface& surface, const Key& key, const WordFormat& format,
          const MarkOptions& options, CostFunction cost)
      : code(key, format),
        scheme(make_scheme(options.scheme, code, options.scheme_options, cost)),
        bound(scheme->bind(surface)) {}

  WordCode code;
  std::unique_ptr<Scheme> scheme;
  std::unique_ptr<BoundScheme> bound;
};

// The numbers that the output can hold.
struct OutputNumbers {
  const Rounding& round;
  double step;  // between neighbours, model units
};

// The stages of marking one mesh, in this order. A message and fill differ in the words, in the
// limit of moves and in the number of rounds.
class MarkStages {
 public:
  MarkStages(const Surface& surface, const Payload& payload, const Key& key,
             const MarkOptions& options, OutputNumbers numbers)
      : surface_(surface),
        message_(std::get_if<Message>(&payload)),
        key_(key),
        options_(options),
        numbers_(numbers),
        diagonal_(surface_diagonal(surface.mesh)) {
    marking_.format = options.format;
    marking_.positions = surface.mesh.positions;
  }

  // Step 1 of the paper: finds the units that do not interfere.
  void select_units();

  // Makes the words. Returns false if there are fewer units than parts: the mesh is too small.
  [[nodiscard]] bool make_words();

  // Step 2 of the paper: assigns words to units and embeds them, again where too many were lost.
  void embed_words() { embed(limits(), marking_); }

  // Sets the status, and returns what was marked.
  [[nodiscard]] Marking finish();

  // Returns what is known of a mesh with fewer units than parts.
  [[nodiscard]] Marking too_small();

 private:
  [[nodiscard]] bool is_fill() const { return message_ == nullptr; }
  [[nodiscard]] MoveLimits limits() const;
  [[nodiscard]] const BoundScheme& moves();
  void embed(const MoveLimits& limits, Marking& marking);
  [[nodiscard]] MarkStatus status_of(const Marking& marking) const;
  [[nodiscard]] double least_move();
  void find_max_move();

  const Surface& surface_;
  const Message* message_;  // null: fill
  const Key& key_;
  const MarkOptions& options_;
  OutputNumbers numbers_;
  double diagonal_;  // model units
  std::optional<Binding> binding_;
  std::optional<Binding> moves_;  // the same, but costs are moves; made when it is needed
  Capacity capacity_;
  Marking marking_;
};

void MarkStages::select_units() {
  Stopwatch watch;
  binding_.emplace(surface_, key_, options_.format, options_, options_.cost);
  const WordCode& code = binding_->code;
  const std::vector<Word> probes = is_fill()
                                       ? code.fill_words(std::min(kProbeWords, code.capacity()))
                                       : code.words_of(*message_);
  capacity_ = find_capacity(surface_, *binding_->bound, probes, options_);
  marking_.layout_seconds = watch.lap();
  marking_.candidates = static_cast<std::uint32_t>(capacity_.units.size());
  marking_.units_valid = static_cast<std::uint32_t>(capacity_.valid.size());
  marking_.units_bound = capacity_.bound;
}

bool MarkStages::make_words() {
  const std::size_t units = capacity_.valid.size();
  if (!is_fill()) {
    marking_.words = binding_->code.words_of(*message_);
    return units >= marking_.words.size();
  }
  if (units == 0) return false;
  if (!options_.keeps_subscript_bits) {
    marking_.format.subscript_bits = fill_subscript_bits(units, options_.format);
  }
  if (marking_.format != options_.format) {
    binding_.emplace(surface_, key_, marking_.format, options_, options_.cost);
  }
  const WordCode& code = binding_->code;
  marking_.words =
      code.fill_words(static_cast<std::uint32_t>(std::min<std::size_t>(units, code.capacity())));
  return true;
}

// What the user limits is a cap; otherwise schemes with units enough aim at moves that are not
// seen.
MoveLimits MarkStages::limits() const {
  if (options_.max_move_percent) return {.cap = *options_.max_move_percent / 100 * diagonal_};
  const bool has_few_units = scheme_info(options_.scheme).defaults(false).has_few_units;
  if (is_fill() || has_few_units) return {};
  return {.aim = kUsualMove / 100 * diagonal_};
}

const BoundScheme& MarkStages::moves() {
  if (options_.cost == CostFunction::Displacement) return *binding_->bound;
  if (!moves_) {
    moves_.emplace(surface_, key_, marking_.format, options_, CostFunction::Displacement);
  }
  return *moves_->bound;
}

void MarkStages::embed(const MoveLimits& limits, Marking& marking) {
  const BoundScheme& scheme = *binding_->bound;
  const BoundScheme& measured = limits.cap > 0 ? moves() : scheme;
  WordAssigner assigner(scheme, measured, capacity_.units, capacity_.valid, marking.words, options_,
                        limits);
  const bool once = is_fill() || options_.assign == AssignMethod::Sequential;
  Stopwatch watch;
  for (int round = 0; round < (once ? 1 : kMaxRounds); ++round) {
    watch.lap();
    const WordPlan plan = is_fill() ? assigner.plan_all() : assigner.plan(options_.redundancy);
    marking.assign_seconds += watch.lap();
    marking.cost_max = plan.cost_max;
    marking.cost_sum = plan.cost_sum;
    marking.units_assigned = static_cast<std::uint32_t>(plan.placements.size());
    settle(surface_, scheme, capacity_.units, plan.placements, {numbers_.round, limits.cap},
           marking);
    const std::vector<Placement> lost = lost_placements(plan.placements, capacity_.units, marking);
    if (lost.empty()) break;
    for (const Placement& placement : lost) assigner.rule_out(placement);
  }
  marking.parts_carried = count_parts(marking);
}

Marking MarkStages::too_small() {
  marking_.status = MarkStatus::TooSmall;
  return std::move(marking_);
}

MarkStatus MarkStages::status_of(const Marking& marking) const {
  const bool lost_most = 2 * marking.units_dropped > marking.units_assigned;
  const bool is_coarse = numbers_.step > kCoarseStep * binding_->bound->cell_size();
  if (lost_most && is_coarse) return MarkStatus::TooCoarse;
  const bool has_all =
      is_fill() ? marking.parts_carried > 0 : marking.parts_carried == marking.words.size();
  return has_all ? MarkStatus::Marked : MarkStatus::TooSmall;
}

// Returns a lower bound of the limit of moves that does, model units.
double MarkStages::least_move() {
  if (!is_fill()) {
    WordAssigner assigner(*binding_->bound, moves(), capacity_.units, capacity_.valid,
                          marking_.words, options_, {});
    return assigner.least_move();
  }
  const std::size_t probes = std::min<std::size_t>(kProbeWords, marking_.words.size());
  const CostMatrix costs = moves().costs(capacity_.units, capacity_.valid,
                                         std::span<const Word>(marking_.words).first(probes));
  return *std::min_element(costs.values.begin(), costs.values.end());
}

// Looks for the least limit, to two digits, within which the mesh can be marked.
void MarkStages::find_max_move() {
  const double needed = 100 * least_move() / diagonal_;
  if (!(needed > 0 && needed < kMostPercent)) return;
  for (double percent = rounded_up(needed); percent <= kMostPercent;
       percent = rounded_up(kRaise * percent)) {
    stop_point();
    Marking trial;
    trial.words = marking_.words;
    embed({.cap = percent / 100 * diagonal_}, trial);
    if (status_of(trial) != MarkStatus::Marked) continue;
    marking_.way_out.move_needed_percent = needed;
    marking_.way_out.max_move_percent = percent;
    return;
  }
}

Marking MarkStages::finish() {
  marking_.status = status_of(marking_);
  if (marking_.status == MarkStatus::TooSmall) {
    find_max_move();
    const bool has_cap = options_.max_move_percent.value_or(0) > 0;
    if (has_cap && marking_.way_out.max_move_percent > 0) {
      marking_.status = MarkStatus::TooVisible;
    }
  }
  return std::move(marking_);
}

}  // namespace

Marking mark(const Surface& surface, const Payload& payload, const Key& key,
             const MarkOptions& options, const Rounding& rounding, double number_step) {
  validate(options.format);
  if (const auto* message = std::get_if<Message>(&payload)) {
    check_message(options.format, message->size());
  }
  MarkStages stages(surface, payload, key, options, {rounding, number_step});
  stages.select_units();
  if (!stages.make_words()) return stages.too_small();
  stages.embed_words();
  return stages.finish();
}

}  // namespace triglyph
