#include "engine/marking/mark.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <numeric>

#include "engine/base/error.h"
#include "engine/geometry/box.h"
#include "engine/marking/plan_words.h"
#include "engine/marking/select_units.h"
#include "engine/marking/settle.h"
#include "engine/scheme/registry.h"

namespace triglyph {
namespace {

// How often words that could not be embedded are dealt out anew before the mesh is taken as it is.
constexpr int kMaxRounds = 16;

// Share of a cell from which on a distance between the output's numbers explains that most units
// were lost: rounding a unit's points by half of it, several at a time, leaves no margin.
constexpr double kCoarseStep = 0.05;

// As many as tell the units apart, at most those the options allow.
int fill_subscript_bits(std::size_t units, const WordFormat& format) {
  return std::clamp(static_cast<int>(std::bit_width(units - 1)), 1, format.subscript_bits);
}

// Placements that did not survive, or none if every part kept at least half of its units.
std::vector<Placement> sorely_missed(std::span<const Placement> placements, const UnitSet& units,
                                     const Marking& marking) {
  std::vector<std::uint32_t> wanted(marking.words.size(), 0);
  std::vector<std::uint32_t> kept(marking.words.size(), 0);
  for (const Carrier& carrier : marking.carriers) ++kept[carrier.word];
  std::vector<Placement> missed;
  auto carrier = marking.carriers.begin();
  for (const Placement& placement : placements) {
    ++wanted[placement.word];
    const bool stands =
        carrier != marking.carriers.end() && carrier->anchor == units.anchors[placement.unit];
    if (stands) {
      ++carrier;
    } else {
      missed.push_back(placement);
    }
  }
  for (std::size_t word = 0; word < wanted.size(); ++word) {
    if (2 * kept[word] < std::max(wanted[word], 1U)) return missed;
  }
  return {};
}

std::uint32_t count_parts(const Marking& marking) {
  std::vector<char> carried(marking.words.size(), 0);
  for (const Carrier& carrier : marking.carriers) carried[carrier.word] = 1;
  return static_cast<std::uint32_t>(std::count(carried.begin(), carried.end(), 1));
}

class Stopwatch {
 public:
  // Seconds since it was made or read last.
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - start_).count();
    start_ = now;
    return seconds;
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace

Marking mark(const Surface& surface, std::span<const std::uint8_t> message, const Key& key,
             const MarkOptions& options, const Rounding& rounding, double number_step) {
  const bool fill = message.empty();
  Marking marking;
  marking.format = options.format;
  marking.positions = surface.mesh.positions;

  const WordCode first_code(key, options.format);
  if (!fill) marking.words = first_code.words_of(message);
  const auto scheme_for = [&](const WordCode& code) {
    return make_scheme(options.scheme, code, options.scheme_options, options.cost);
  };

  // step 1: which units there are
  Stopwatch watch;
  const std::vector<Word> words =
      fill ? first_code.fill_words(std::min(kProbeWords, first_code.capacity())) : marking.words;
  auto scheme = scheme_for(first_code);
  auto bound = scheme->bind(surface);
  const Capacity capacity = find_capacity(surface, *bound, words, options);
  const UnitSet& units = capacity.units;
  const std::vector<std::uint32_t>& valid = capacity.valid;
  marking.layout_seconds = watch.lap();
  marking.candidates = static_cast<std::uint32_t>(units.size());
  marking.units_valid = static_cast<std::uint32_t>(valid.size());
  marking.units_bound = capacity.bound;

  if (fill && !valid.empty() && !options.keeps_subscript_bits) {
    marking.format.subscript_bits = fill_subscript_bits(valid.size(), options.format);
  }
  const WordCode code(key, marking.format);
  if (fill) {
    marking.words = code.fill_words(
        static_cast<std::uint32_t>(std::min<std::size_t>(valid.size(), code.capacity())));
  }
  if (valid.empty() || valid.size() < marking.words.size()) {
    marking.status = MarkStatus::TooSmall;
    return marking;
  }

  // step 2: which word each unit carries; what proves impossible is dealt out anew
  if (marking.format != options.format) {
    bound.reset();
    scheme = scheme_for(code);
    bound = scheme->bind(surface);
  }
  const double limit =
      fill ? 0 : options.max_move_percent / 100 * box_diagonal(surface.mesh.positions);
  WordAssigner assigner(*bound, units, valid, marking.words, options, limit);
  const bool once = fill || options.assign == AssignMethod::Sequential;
  for (int round = 0; round < (once ? 1 : kMaxRounds); ++round) {
    watch.lap();
    const WordPlan plan = assigner.plan(fill ? 0 : options.redundancy);
    marking.assign_seconds += watch.lap();
    marking.cost_max = plan.cost_max;
    marking.cost_sum = plan.cost_sum;
    marking.units_assigned = static_cast<std::uint32_t>(plan.placements.size());
    settle(surface, *bound, units, plan.placements, rounding, marking);
    const std::vector<Placement> missed = sorely_missed(plan.placements, units, marking);
    if (missed.empty()) break;
    for (const Placement& placement : missed) assigner.rule_out(placement);
  }
  marking.parts_carried = count_parts(marking);
  if (!fill && marking.parts_carried < marking.words.size()) marking.status = MarkStatus::TooSmall;
  const bool mostly_lost = 2 * marking.units_dropped > marking.units_assigned;
  const bool is_coarse = number_step > kCoarseStep * bound->cell_size();
  if (mostly_lost && is_coarse) marking.status = MarkStatus::TooCoarse;
  return marking;
}

}  // namespace triglyph
