#include "engine/mark.h"

#include <algorithm>
#include <bit>
#include <numeric>

#include "engine/base/error.h"
#include "engine/base/parallel.h"
#include "engine/settle.h"

namespace triglyph {
namespace {

// Pairs of unit and word that one assignment looks at: 256 MB of costs. More units than fit are
// dealt into blocks, each with its share of the demand; beyond that size the optimum is one of
// blocks.
constexpr std::size_t kMaxPairs = std::size_t{1} << 26;

Assignment assign(const CostMatrix& costs, std::span<const std::uint32_t> demand,
                  AssignMethod method) {
  switch (method) {
    case AssignMethod::Sequential:
      return assign_sequential(costs, demand);
    case AssignMethod::Bottleneck:
      return assign_bottleneck(costs, demand);
    case AssignMethod::Sum:
      return assign_least_sum(costs, demand);
  }
  throw Error(ErrorCode::Usage, {}, "", "unknown assignment");
}

// How many units each part wants: the redundancy, or what the units allow, as evenly as can be.
std::vector<std::uint32_t> share_demand(std::size_t units, std::size_t parts,
                                        std::uint32_t redundancy) {
  const std::size_t wanted =
      redundancy == 0 ? units : std::min<std::size_t>(units, redundancy * parts);
  std::vector<std::uint32_t> demand(parts);
  for (std::size_t part = 0; part < parts; ++part) {
    demand[part] = static_cast<std::uint32_t>(wanted / parts + (part < wanted % parts ? 1 : 0));
  }
  return demand;
}

int fill_subscript_bits(std::size_t units) {
  return std::clamp(static_cast<int>(std::bit_width(units - 1)), 1, kMaxFillSubscriptBits);
}

// Which word every valid unit carries, block by block.
std::vector<Placement> assign_words(const Surface& surface, const Scheme& scheme,
                                    const UnitSet& units, std::span<const std::uint32_t> valid,
                                    const MarkOptions& options, std::uint32_t redundancy,
                                    Marking& marking) {
  const std::size_t words = marking.words.size();
  const std::vector<std::uint32_t> demand = share_demand(valid.size(), words, redundancy);
  const std::size_t blocks = (valid.size() * words + kMaxPairs - 1) / kMaxPairs;
  std::vector<Placement> placements;
  for (std::size_t block = 0; block < blocks; ++block) {
    std::vector<std::uint32_t> chosen;
    for (std::size_t i = block; i < valid.size(); i += blocks) chosen.push_back(valid[i]);
    std::vector<std::uint32_t> share(words);
    for (std::size_t word = 0; word < words; ++word) {
      const auto part = [&](std::size_t b) { return demand[word] * b / blocks; };
      share[word] = static_cast<std::uint32_t>(part(block + 1) - part(block));
    }
    const CostMatrix costs = scheme.costs(surface, units, chosen, marking.words);
    const Assignment assignment = assign(costs, share, options.assign);
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      if (assignment.word_of_unit[i] == kNoWord) continue;
      placements.push_back({chosen[i], assignment.word_of_unit[i]});
    }
    marking.cost_max = std::max(marking.cost_max, assignment.max_cost);
    marking.cost_sum += assignment.sum_cost;
  }
  std::sort(placements.begin(), placements.end(),
            [](const Placement& a, const Placement& b) { return a.unit < b.unit; });
  return placements;
}

double mean_edge(const Mesh& mesh) {
  const double total = parallel_reduce(
      mesh.triangles.size(), 0.0,
      [&](std::size_t t) {
        const Triangle& triangle = mesh.triangles[t];
        double sum = 0;
        for (std::size_t i = 0; i < 3; ++i) {
          sum += (mesh.positions[triangle[(i + 1) % 3]] - mesh.positions[triangle[i]]).norm();
        }
        return sum;
      },
      [](double a, double b) { return a + b; });
  return mesh.triangles.empty() ? 0 : total / (3.0 * static_cast<double>(mesh.triangles.size()));
}

}  // namespace

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

Marking mark(const Surface& surface, std::span<const std::uint8_t> message, const Key& key,
             const MarkOptions& options, const Rounding& round, double number_step) {
  const bool fill = message.empty();
  Marking marking;
  marking.format = options.format;
  marking.positions = surface.mesh.positions;

  const WordCode first_code(key, options.format);
  if (!fill) marking.words = first_code.words_of(message);
  const auto scheme_for = [&](const WordCode& code) {
    return make_scheme(options.scheme, code, options.scheme_options);
  };

  // step 1: which units there are
  const UnitSet units = scheme_for(first_code)->find_units(surface);
  const Conflicts conflicts(units, surface.mesh.positions.size(), options.conflict_rule);
  const std::vector<std::uint32_t> valid = choose_layout(conflicts, options.layout);
  marking.candidates = static_cast<std::uint32_t>(units.size());
  marking.units_valid = static_cast<std::uint32_t>(valid.size());
  marking.units_bound = layout_bound(conflicts);

  if (fill && !valid.empty()) marking.format.subscript_bits = fill_subscript_bits(valid.size());
  const WordCode code(key, marking.format);
  if (fill) {
    marking.words = code.fill_words(
        static_cast<std::uint32_t>(std::min<std::size_t>(valid.size(), code.capacity())));
  }
  if (valid.empty() || valid.size() < marking.words.size()) {
    marking.status = MarkStatus::TooSmall;
    return marking;
  }

  // step 2: which word each unit carries
  const auto scheme = scheme_for(code);
  const std::vector<Placement> placements =
      assign_words(surface, *scheme, units, valid, options, fill ? 0 : options.redundancy, marking);
  marking.units_assigned = static_cast<std::uint32_t>(placements.size());

  settle(surface, *scheme, units, placements, round, marking);
  const bool mostly_lost = 2 * marking.units_dropped > marking.units_assigned;
  const double cell = options.scheme_options.step * mean_edge(surface.mesh);
  if (mostly_lost && number_step > 0.05 * cell) marking.status = MarkStatus::TooCoarse;
  return marking;
}

}  // namespace triglyph
