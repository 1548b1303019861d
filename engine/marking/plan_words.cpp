#include "engine/marking/plan_words.h"

#include <algorithm>

#include "engine/assignment/assignment.h"
#include "engine/base/error.h"
#include "engine/base/stop.h"

namespace triglyph {
namespace {

// Most pairs of unit and word in one assignment: 256 MB of costs. Beyond it the units are split
// into blocks, each with its share of the demand, and the assignment is optimal within blocks only.
constexpr std::size_t kMaxPairs = std::size_t{1} << 26;

constexpr std::size_t kNoBlock = static_cast<std::size_t>(-1);

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

// Returns the demand of each word: the units divided as evenly as possible, first words first.
std::vector<std::uint32_t> share_demand(std::size_t units, std::size_t words) {
  std::vector<std::uint32_t> demand(words);
  for (std::size_t word = 0; word < words; ++word) {
    demand[word] = static_cast<std::uint32_t>(units / words + (word < units % words ? 1 : 0));
  }
  return demand;
}

}  // namespace

WordAssigner::WordAssigner(const BoundScheme& scheme, const BoundScheme& moves,
                           const UnitSet& units, std::span<const std::uint32_t> valid,
                           std::span<const Word> words, std::uint32_t parts,
                           const MarkOptions& options, const MoveLimits& limits)
    : scheme_(scheme),
      moves_(moves),
      units_(units),
      valid_(valid),
      words_(words),
      parts_(parts),
      options_(options),
      limits_(limits),
      blocks_(std::max<std::size_t>(1, (valid.size() * words.size() + kMaxPairs - 1) / kMaxPairs)),
      costs_of_block_(kNoBlock) {}

std::vector<std::uint32_t> WordAssigner::demand_of(std::uint32_t redundancy) const {
  const std::size_t wanted =
      redundancy == 0 ? valid_.size() : std::min(valid_.size(), redundancy * parts_);
  return share_demand(wanted, words_.size());
}

// With a cap, pairs beyond it are infeasible already; what counts is that no part is left with too
// few units, since a maximum matching may serve one part with all copies and another with none.
bool WordAssigner::is_within_limits(const WordPlan& plan, std::uint32_t redundancy) const {
  if (has_aim()) return redundancy == 0 || plan.cost_max <= limits_.aim;
  if (limits_.cap == 0 || options_.assign == AssignMethod::Sequential) return true;
  const std::vector<std::uint32_t> demand = demand_of(redundancy);
  std::vector<std::uint32_t> placed(words_.size(), 0);
  for (const Placement& placement : plan.placements) ++placed[placement.word];
  for (std::size_t word = 0; word < parts_; ++word) {
    if (placed[word] < std::min(kMinRedundancy, demand[word])) return false;
  }
  return true;
}

WordPlan WordAssigner::plan(std::uint32_t redundancy) {
  WordPlan best = solve(redundancy);
  if (is_within_limits(best, redundancy)) return best;
  // bisection for the greatest redundancy within the limits; the least in any case
  const auto possible = static_cast<std::uint32_t>((valid_.size() - 1) / parts_ + 1);
  std::uint32_t too_many = redundancy == 0 ? possible : std::min(redundancy, possible);
  std::uint32_t enough = std::min(has_aim() ? kMinRedundancy : 1, too_many);
  best = solve(enough);
  while (is_within_limits(best, enough) && too_many - enough > 1) {
    const std::uint32_t middle = enough + (too_many - enough) / 2;
    WordPlan candidate = solve(middle);
    if (is_within_limits(candidate, middle)) {
      best = std::move(candidate);
      enough = middle;
    } else {
      too_many = middle;
    }
  }
  return best;
}

double WordAssigner::least_move() {
  check(limits_.cap == 0 && limits_.aim == 0, "the least move is that without limits");
  std::vector<std::uint32_t> demand(words_.size(), 0);
  std::fill_n(demand.begin(), parts_, 1);
  return assign_bottleneck(moves_.costs(units_, block_units(0), words_), demand).max_cost;
}

WordPlan WordAssigner::solve(std::uint32_t redundancy) {
  const std::vector<std::uint32_t> demand = demand_of(redundancy);
  WordPlan plan;
  for (std::size_t block = 0; block < blocks_; ++block) {
    stop_point();
    std::vector<std::uint32_t> share(words_.size());
    for (std::size_t word = 0; word < words_.size(); ++word) {
      const auto until = [&](std::size_t b) { return std::size_t{demand[word]} * b / blocks_; };
      share[word] = static_cast<std::uint32_t>(until(block + 1) - until(block));
    }
    const std::vector<std::uint32_t> chosen = block_units(block);
    const Assignment assignment = assign(block_costs(block, chosen), share, options_.assign);
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      if (assignment.word_of_unit[i] == kNoWord) continue;
      plan.placements.push_back({chosen[i], assignment.word_of_unit[i]});
    }
    plan.cost_max = std::max(plan.cost_max, assignment.max_cost);
    plan.cost_sum += assignment.sum_cost;
  }
  std::sort(plan.placements.begin(), plan.placements.end(),
            [](const Placement& a, const Placement& b) { return a.unit < b.unit; });
  return plan;
}

WordPlan WordAssigner::plan_cheapest() {
  WordPlan plan;
  for (std::size_t block = 0; block < blocks_; ++block) {
    stop_point();
    const std::vector<std::uint32_t> chosen = block_units(block);
    const CostMatrix& costs = block_costs(block, chosen);
    for (std::uint32_t row = 0; row < chosen.size(); ++row) {
      std::uint32_t best = 0;
      for (std::uint32_t word = 1; word < costs.words; ++word) {
        if (costs.at(row, word) < costs.at(row, best)) best = word;
      }
      const float cost = costs.at(row, best);
      if (cost == kInfeasible) continue;
      plan.placements.push_back({chosen[row], best});
      plan.cost_max = std::max(plan.cost_max, double{cost});
      plan.cost_sum += double{cost};
    }
  }
  std::sort(plan.placements.begin(), plan.placements.end(),
            [](const Placement& a, const Placement& b) { return a.unit < b.unit; });
  return plan;
}

std::vector<std::uint32_t> WordAssigner::block_units(std::size_t block) const {
  std::vector<std::uint32_t> chosen;
  for (std::size_t i = block; i < valid_.size(); i += blocks_) chosen.push_back(valid_[i]);
  return chosen;
}

// Makes the pairs infeasible that move a point too far.
void WordAssigner::leave_out_far(std::span<const std::uint32_t> chosen) {
  if (limits_.cap == 0 && !has_aim()) return;
  const auto farthest =
      static_cast<float>(limits_.cap > 0 ? limits_.cap : kVisibleMove * limits_.aim);
  const bool costs_are_moves = limits_.cap == 0 || &moves_ == &scheme_;
  const CostMatrix moves = costs_are_moves ? CostMatrix{} : moves_.costs(units_, chosen, words_);
  const std::vector<float>& far = costs_are_moves ? costs_.values : moves.values;
  for (std::size_t pair = 0; pair < far.size(); ++pair) {
    if (far[pair] > farthest) costs_.values[pair] = kInfeasible;
  }
}

const CostMatrix& WordAssigner::block_costs(std::size_t block,
                                            std::span<const std::uint32_t> chosen) {
  if (costs_of_block_ != block) {
    costs_ = scheme_.costs(units_, chosen, words_);
    costs_of_block_ = block;
    leave_out_far(chosen);
  }
  for (const auto& [unit, word] : ruled_out_) {
    const auto at = std::lower_bound(chosen.begin(), chosen.end(), unit);
    if (at == chosen.end() || *at != unit) continue;
    costs_
        .values[std::size_t{word} * chosen.size() + static_cast<std::size_t>(at - chosen.begin())] =
        kInfeasible;
  }
  return costs_;
}

}  // namespace triglyph
