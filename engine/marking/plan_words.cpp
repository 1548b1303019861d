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

// Returns the demand of each part: the redundancy, or what the units allow, as evenly as possible.
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

}  // namespace

WordAssigner::WordAssigner(const BoundScheme& scheme, const UnitSet& units,
                           std::span<const std::uint32_t> valid, std::span<const Word> words,
                           const MarkOptions& options, double max_cost)
    : scheme_(scheme),
      units_(units),
      valid_(valid),
      words_(words),
      options_(options),
      max_cost_(max_cost),
      blocks_(std::max<std::size_t>(1, (valid.size() * words.size() + kMaxPairs - 1) / kMaxPairs)),
      costs_of_block_(kNoBlock) {}

WordPlan WordAssigner::plan(std::uint32_t redundancy) {
  WordPlan best = solve(redundancy);
  if (!is_limited() || redundancy == 0 || best.cost_max <= max_cost_) return best;
  // bisection for the greatest redundancy within the limit; kMinRedundancy in any case
  const auto possible = static_cast<std::uint32_t>((valid_.size() - 1) / words_.size() + 1);
  std::uint32_t too_many = std::min(redundancy, possible);
  std::uint32_t enough = std::min(kMinRedundancy, too_many);
  best = solve(enough);
  while (best.cost_max <= max_cost_ && too_many - enough > 1) {
    const std::uint32_t middle = enough + (too_many - enough) / 2;
    WordPlan candidate = solve(middle);
    if (candidate.cost_max <= max_cost_) {
      best = std::move(candidate);
      enough = middle;
    } else {
      too_many = middle;
    }
  }
  return best;
}

WordPlan WordAssigner::solve(std::uint32_t redundancy) {
  const std::vector<std::uint32_t> demand = share_demand(valid_.size(), words_.size(), redundancy);
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

std::vector<std::uint32_t> WordAssigner::block_units(std::size_t block) const {
  std::vector<std::uint32_t> chosen;
  for (std::size_t i = block; i < valid_.size(); i += blocks_) chosen.push_back(valid_[i]);
  return chosen;
}

const CostMatrix& WordAssigner::block_costs(std::size_t block,
                                            std::span<const std::uint32_t> chosen) {
  if (costs_of_block_ != block) {
    costs_ = scheme_.costs(units_, chosen, words_);
    costs_of_block_ = block;
    const auto visible = static_cast<float>(kVisibleMove * max_cost_);
    if (is_limited()) {
      for (float& cost : costs_.values) {
        if (cost > visible) cost = kInfeasible;
      }
    }
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
