// Step 2 of the paper on a mesh: which valid unit carries which watermark word, and how many units
// each part gets.
// Wang & Hu, CAGD 27 (2010), section 2.2; the choice of the redundancy is ours.
#pragma once

#include <set>
#include <span>
#include <utility>
#include <vector>

#include "engine/marking/options.h"

namespace triglyph {

// Every part gets at least this many units if there are enough, so that a few can be lost; more
// only as long as no point moves farther than MarkOptions::max_move_percent.
inline constexpr std::uint32_t kMinRedundancy = 4;

// A pair that moves a point farther than this many times the limit is infeasible: it would be seen.
inline constexpr double kVisibleMove = 10;

struct WordPlan {
  std::vector<Placement> placements;  // by ascending unit
  double cost_max = 0;                // model units
  double cost_sum = 0;
};

class WordAssigner {
 public:
  // All references must outlive the assigner. `max_cost` is in model units; 0: no limit.
  WordAssigner(const BoundScheme& scheme, const UnitSet& units,
               std::span<const std::uint32_t> valid, std::span<const Word> words,
               const MarkOptions& options, double max_cost);

  // Returns the best plan without the pairs that were ruled out, with `redundancy` units per part
  // or as many as the limit of cost allows; 0 uses every valid unit. Sequential assignment has no
  // limit of cost.
  [[nodiscard]] WordPlan plan(std::uint32_t redundancy);

  // Excludes a pair, because it could not be embedded, from further plans.
  void rule_out(const Placement& placement) { ruled_out_.insert({placement.unit, placement.word}); }

 private:
  [[nodiscard]] bool is_limited() const {
    return max_cost_ > 0 && options_.assign != AssignMethod::Sequential;
  }
  [[nodiscard]] WordPlan solve(std::uint32_t redundancy);
  [[nodiscard]] std::vector<std::uint32_t> block_units(std::size_t block) const;
  [[nodiscard]] const CostMatrix& block_costs(std::size_t block,
                                              std::span<const std::uint32_t> chosen);

  const BoundScheme& scheme_;
  const UnitSet& units_;
  std::span<const std::uint32_t> valid_;
  std::span<const Word> words_;
  const MarkOptions& options_;
  double max_cost_;
  std::size_t blocks_;
  std::size_t costs_of_block_;  // the block that costs_ holds
  CostMatrix costs_;
  std::set<std::pair<std::uint32_t, std::uint32_t>> ruled_out_;
};

}  // namespace triglyph
