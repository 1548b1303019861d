#include "engine/marking/mark_stages.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <utility>
#include <variant>

#include "engine/base/stop.h"
#include "engine/marking/settle.h"
#include "engine/mesh/surface_diagonal.h"
#include "engine/scheme/registry.h"

namespace triglyph {
namespace {

// How often placements that failed are ruled out and the words assigned anew before the mark is
// taken as it is.
constexpr int kMaxRounds = 16;

// One in so many places is read to see whether a mesh looks marked: it takes a sixth of the time of
// reading all, and leaves about 5 of the 32 units that a part usually has.
constexpr std::uint32_t kOneInSample = 6;

// Whoever wants fewer units a part than these may have marked the mesh with as few before, and the
// sample would not show them; nor would it those of a small mesh, which is quickly read.
constexpr std::uint32_t kSampledRedundancy = 32;
constexpr std::size_t kSampledTriangles = 30'000;

// A message has up to so many words for each part that it needs; more correct hardly more errors,
// and a mesh that carries it already is known by words that repeat.
constexpr std::uint32_t kMostWordsPerPart = 4;

// Words beyond those that are needed are made if there are so many units for each word: what
// carries a part by itself is needed more.
constexpr std::size_t kUnitsPerWord = 4;

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

// Returns how many of the first words have a carrier.
std::uint32_t count_carried(const Marking& marking, std::size_t words) {
  std::vector<char> is_carried(words, 0);
  for (const Carrier& carrier : marking.carriers) {
    if (carrier.word < words) is_carried[carrier.word] = 1;
  }
  return static_cast<std::uint32_t>(std::count(is_carried.begin(), is_carried.end(), 1));
}

class Stopwatch {
 public:
  [[nodiscard]] double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace

MarkStages::Binding::Binding(const MarkTask& task, const WordFormat& format, CostFunction cost)
    : code(task.key, format),
      scheme(make_scheme(task.options.scheme, code, task.options.scheme_options, cost)),
      bound(scheme->bind(task.surface)) {}

MarkStages::MarkStages(const MarkTask& task)
    : task_(task),
      message_(std::get_if<Message>(&task.payload)),
      diagonal_(surface_diagonal(task.surface.mesh)) {
  marking_.format = task.options.format;
  marking_.positions = task.surface.mesh.positions;
  const Stopwatch watch;
  binding_.emplace(task, task.options.format, task.options.cost);
  marking_.layout_seconds = watch.seconds();
}

Extraction MarkStages::read() const {
  const std::uint32_t redundancy = task_.options.redundancy;
  const bool is_large = task_.surface.mesh.triangles.size() >= kSampledTriangles;
  if (is_large && (redundancy == 0 || redundancy >= kSampledRedundancy)) {
    const auto sample = binding_->bound->read_sample(kOneInSample);
    if (sample && !has_repeated_words(*sample, task_.options.format)) return {};
  }
  return extract_as_is(*binding_->bound, binding_->code,
                       doubtful_parts(task_.options.scheme_options));
}

void MarkStages::select_units() {
  const Stopwatch watch;
  const WordCode& code = binding_->code;
  const std::vector<Word> probes = is_fill()
                                       ? code.fill_words(std::min(kProbeWords, code.capacity()))
                                       : code.words_of(*message_);
  capacity_ = find_capacity(task_.surface, *binding_->bound, probes, task_.options);
  marking_.layout_seconds += watch.seconds();
  marking_.candidates = static_cast<std::uint32_t>(capacity_.units.size());
  marking_.units_valid = static_cast<std::uint32_t>(capacity_.valid.size());
  marking_.units_bound = capacity_.bound;
}

bool MarkStages::make_words() {
  const std::size_t units = capacity_.valid.size();
  if (!is_fill()) {
    set_message(*message_, units, marking_);
    return units >= marking_.parts_needed;
  }
  if (units == 0) return false;
  if (!task_.options.keeps_subscript_bits) {
    marking_.format.subscript_bits = fill_subscript_bits(units, task_.options.format);
  }
  if (marking_.format != task_.options.format) {
    binding_.emplace(task_, marking_.format, task_.options.cost);
  }
  const WordCode& code = binding_->code;
  marking_.words =
      code.fill_words(static_cast<std::uint32_t>(std::min<std::size_t>(units, code.capacity())));
  return true;
}

void MarkStages::set_message(std::span<const std::uint8_t> message, std::size_t units,
                             Marking& marking) const {
  const WordCode& code = binding_->code;
  marking.parts_needed = least_units_for(marking_.format, message.size());
  if (is_spread()) {
    marking.words = code.words_of(message);
    return;
  }
  const std::size_t parts = marking.parts_needed;
  const std::size_t redundancy = task_.options.redundancy;
  const std::size_t used = redundancy == 0 ? units : std::min(units, redundancy * parts);
  marking.words = code.words_of(message, static_cast<std::uint32_t>(std::min(
                                             used / kUnitsPerWord, kMostWordsPerPart * parts)));
}

// What the user limits is a cap; otherwise schemes with units enough aim at moves that are not
// seen.
MoveLimits MarkStages::limits() const {
  const MarkOptions& options = task_.options;
  if (options.max_move_percent) return {.cap = *options.max_move_percent / 100 * diagonal_};
  const bool has_few_units =
      scheme_info(options.scheme).defaults(false, options.strength).has_few_units;
  if (is_fill() || has_few_units) return {};
  return {.aim = kUsualMove / 100 * diagonal_};
}

const BoundScheme& MarkStages::moves() {
  if (task_.options.cost == CostFunction::Displacement) return *binding_->bound;
  if (!moves_) moves_.emplace(task_, marking_.format, CostFunction::Displacement);
  return *moves_->bound;
}

// Words with parities take units that a part may need where units are scarce.
void MarkStages::embed(const MoveLimits& limits, const Capacity& capacity, Marking& marking) {
  embed_once(limits, capacity, marking);
  const bool has_others = !is_fill() && !is_spread() && marking.words.size() > marking.parts_needed;
  if (!has_others || marking.parts_carried == marking.parts_needed) return;
  marking.words.resize(marking.parts_needed);
  embed_once(limits, capacity, marking);
}

void MarkStages::embed_once(const MoveLimits& limits, const Capacity& capacity, Marking& marking) {
  const MarkOptions& options = task_.options;
  const BoundScheme& scheme = *binding_->bound;
  const BoundScheme& measured = limits.cap > 0 ? moves() : scheme;
  const auto parts =
      is_fill() ? static_cast<std::uint32_t>(marking.words.size()) : marking.parts_needed;
  WordAssigner assigner(scheme, measured, capacity.units, capacity.valid, marking.words, parts,
                        options, limits);
  const bool once = is_fill() || is_spread() || options.assign == AssignMethod::Sequential;
  for (int round = 0; round < (once ? 1 : kMaxRounds); ++round) {
    stop_point();
    const Stopwatch watch;
    const WordPlan plan = is_fill()     ? assigner.plan_all()
                          : is_spread() ? assigner.plan_cheapest()
                                        : assigner.plan(options.redundancy);
    marking.assign_seconds += watch.seconds();
    marking.cost_max = plan.cost_max;
    marking.cost_sum = plan.cost_sum;
    marking.units_assigned = static_cast<std::uint32_t>(plan.placements.size());
    settle(task_.surface, scheme, capacity.units, plan.placements,
           {task_.output.round, limits.cap, task_.output.recut}, marking);
    const std::vector<Placement> lost = lost_placements(plan.placements, capacity.units, marking);
    if (lost.empty()) break;
    for (const Placement& placement : lost) assigner.rule_out(placement);
  }
  const std::size_t wanted = is_fill() || is_spread() ? marking.words.size() : marking.parts_needed;
  marking.parts_carried = count_carried(marking, wanted);
  if (is_spread()) marking.is_readable = reads_back(marking);
}

// How many units it takes depends on the sites without a mark, so that only reading tells.
bool MarkStages::reads_back(const Marking& marking) const {
  if (marking.parts_carried < marking.parts_needed) return false;
  const Mesh marked{marking.positions, task_.surface.mesh.triangles};
  const auto bound = binding_->bound->moved_to({marked, task_.surface.halfedges});
  const Extraction found = extract_as_is(*bound, binding_->code);
  return found.message && binding_->code.words_of(*found.message) == marking.words;
}

MarkStatus MarkStages::status_of(const Marking& marking) const {
  const bool lost_most = 2 * marking.units_dropped > marking.units_assigned;
  const bool is_coarse = task_.output.step > kCoarseStep * binding_->bound->cell_size();
  if (lost_most && is_coarse) return MarkStatus::TooCoarse;
  bool has_all = marking.parts_carried == marking.parts_needed;
  if (is_fill()) has_all = marking.parts_carried > 0;
  if (is_spread()) has_all = marking.is_readable;
  return has_all ? MarkStatus::Marked : MarkStatus::TooSmall;
}

Marking MarkStages::marked_within(double max_move_percent) {
  Marking trial;
  trial.words = marking_.words;
  trial.parts_needed = marking_.parts_needed;
  embed({.cap = max_move_percent / 100 * diagonal_}, capacity_, trial);
  trial.status = status_of(trial);
  return trial;
}

Marking MarkStages::marked_with(std::span<const std::uint8_t> message) {
  Marking trial;
  set_message(message, capacity_.valid.size(), trial);
  trial.status = MarkStatus::TooSmall;
  // then the words decide which candidates are left out
  const bool depends_on_words = task_.options.drop_dearest_percent > 0;
  const Capacity other =
      depends_on_words ? find_capacity(task_.surface, *binding_->bound, trial.words, task_.options)
                       : Capacity{};
  const Capacity& capacity = depends_on_words ? other : capacity_;
  if (capacity.valid.size() < trial.parts_needed) return trial;
  embed(limits(), capacity, trial);
  trial.status = status_of(trial);
  return trial;
}

double MarkStages::least_move_percent() {
  if (!is_fill()) {
    WordAssigner assigner(*binding_->bound, moves(), capacity_.units, capacity_.valid,
                          marking_.words, marking_.parts_needed, task_.options, {});
    return 100 * assigner.least_move() / diagonal_;
  }
  const std::size_t probes = std::min<std::size_t>(kProbeWords, marking_.words.size());
  const CostMatrix costs = moves().costs(capacity_.units, capacity_.valid,
                                         std::span<const Word>(marking_.words).first(probes));
  return 100 * *std::min_element(costs.values.begin(), costs.values.end()) / diagonal_;
}

}  // namespace triglyph
