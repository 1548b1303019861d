#include "engine/marking/mark.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <memory>
#include <optional>
#include <utility>
#include <variant>

#include "engine/geometry/box.h"
#include "engine/marking/plan_words.h"
#include "engine/marking/select_units.h"
#include "engine/marking/settle.h"
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
          const MarkOptions& options)
      : code(key, format),
        scheme(make_scheme(options.scheme, code, options.scheme_options, options.cost)),
        bound(scheme->bind(surface)) {}

  WordCode code;
  std::unique_ptr<Scheme> scheme;
  std::unique_ptr<BoundScheme> bound;
};

// The stages of marking one mesh, in this order. A message and fill differ in the words, in the
// limit of moves and in the number of rounds.
class MarkStages {
 public:
  MarkStages(const Surface& surface, const Payload& payload, const Key& key,
             const MarkOptions& options)
      : surface_(surface), message_(std::get_if<Message>(&payload)), key_(key), options_(options) {
    marking_.format = options.format;
    marking_.positions = surface.mesh.positions;
  }

  // Step 1 of the paper: finds the units that do not interfere.
  void select_units();

  // Makes the words. Returns false if there are fewer units than parts: the mesh is too small.
  [[nodiscard]] bool make_words();

  // Step 2 of the paper: assigns words to units and embeds them, again where too many were lost.
  void embed_words(const Rounding& rounding);

  // Sets the status, and returns what was marked.
  [[nodiscard]] Marking finish(double number_step);

  // Returns what is known of a mesh with fewer units than parts.
  [[nodiscard]] Marking too_small();

 private:
  [[nodiscard]] bool is_fill() const { return message_ == nullptr; }

  const Surface& surface_;
  const Message* message_;  // null: fill
  const Key& key_;
  const MarkOptions& options_;
  std::optional<Binding> binding_;
  Capacity capacity_;
  Marking marking_;
};

void MarkStages::select_units() {
  Stopwatch watch;
  binding_.emplace(surface_, key_, options_.format, options_);
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
    binding_.emplace(surface_, key_, marking_.format, options_);
  }
  const WordCode& code = binding_->code;
  marking_.words =
      code.fill_words(static_cast<std::uint32_t>(std::min<std::size_t>(units, code.capacity())));
  return true;
}

void MarkStages::embed_words(const Rounding& rounding) {
  const BoundScheme& scheme = *binding_->bound;
  const double limit =
      is_fill() ? 0 : options_.max_move_percent / 100 * box_diagonal(surface_.mesh.positions);
  WordAssigner assigner(scheme, capacity_.units, capacity_.valid, marking_.words, options_, limit);
  const bool once = is_fill() || options_.assign == AssignMethod::Sequential;
  Stopwatch watch;
  for (int round = 0; round < (once ? 1 : kMaxRounds); ++round) {
    watch.lap();
    const WordPlan plan = assigner.plan(is_fill() ? 0 : options_.redundancy);
    marking_.assign_seconds += watch.lap();
    marking_.cost_max = plan.cost_max;
    marking_.cost_sum = plan.cost_sum;
    marking_.units_assigned = static_cast<std::uint32_t>(plan.placements.size());
    settle(surface_, scheme, capacity_.units, plan.placements, rounding, marking_);
    const std::vector<Placement> lost = lost_placements(plan.placements, capacity_.units, marking_);
    if (lost.empty()) break;
    for (const Placement& placement : lost) assigner.rule_out(placement);
  }
}

Marking MarkStages::too_small() {
  marking_.status = MarkStatus::TooSmall;
  return std::move(marking_);
}

Marking MarkStages::finish(double number_step) {
  marking_.parts_carried = count_parts(marking_);
  if (!is_fill() && marking_.parts_carried < marking_.words.size()) {
    marking_.status = MarkStatus::TooSmall;
  }
  const bool lost_most = 2 * marking_.units_dropped > marking_.units_assigned;
  const bool is_coarse = number_step > kCoarseStep * binding_->bound->cell_size();
  if (lost_most && is_coarse) marking_.status = MarkStatus::TooCoarse;
  return std::move(marking_);
}

}  // namespace

Marking mark(const Surface& surface, const Payload& payload, const Key& key,
             const MarkOptions& options, const Rounding& rounding, double number_step) {
  validate(options.format);
  if (const auto* message = std::get_if<Message>(&payload)) {
    check_message(options.format, message->size());
  }
  MarkStages stages(surface, payload, key, options);
  stages.select_units();
  if (!stages.make_words()) return stages.too_small();
  stages.embed_words(rounding);
  return stages.finish(number_step);
}

}  // namespace triglyph
