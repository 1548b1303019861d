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
// only within the limits of moves.
inline constexpr std::uint32_t kMinRedundancy = 4;

// The farthest move, in percent of the surface's diagonal, at which parts still get more units than
// these, unless the user sets a limit. Moves of a tenth of a percent are not seen on large meshes.
inline constexpr double kUsualMove = 0.1;

// A pair that moves a point farther than this many times the usual is infeasible: it would be seen.
inline constexpr double kVisibleMove = 10;

// Limits of how far points move, in model units; 0: none.
struct MoveLimits {
  double aim = 0;  // reduces the redundancy, see above; not with sequential assignment
  double cap = 0;  // is never exceeded; with it, `aim` has no effect
};

struct WordPlan {
  std::vector<Placement> placements;  // by ascending unit
  double cost_max = 0;                // model units
  double cost_sum = 0;
};

class WordAssigner {
 public:
  // All references must outlive the assigner. `moves` is a binding of the same scheme to the same
  // surface whose costs are moves; the cap is kept in these. The first `parts` words are those that
  // a message needs.
  WordAssigner(const BoundScheme& scheme, const BoundScheme& moves, const UnitSet& units,
               std::span<const std::uint32_t> valid, std::span<const Word> words,
               std::uint32_t parts, const MarkOptions& options, const MoveLimits& limits);

  // Returns the best plan without the pairs that were ruled out, with `redundancy` units for each
  // part that is needed, divided among all words, or as many as the limits of moves allow; 0 uses
  // every valid unit.
  [[nodiscard]] WordPlan plan(std::uint32_t redundancy);

  // Returns the best plan of every valid unit that can carry one of the words.
  [[nodiscard]] WordPlan plan_all() { return solve(0); }

  // Returns the plan in which every valid unit carries the word that it carries at least cost, for
  // words of which any may be left out.
  [[nodiscard]] WordPlan plan_cheapest();

  // Returns the least move that some part needs in every plan that gives each part a unit, model
  // units; exact where one assignment holds all units. Precondition: no limits.
  [[nodiscard]] double least_move();

  // Excludes a pair, because it could not be embedded, from further plans.
  void rule_out(const Placement& placement) { ruled_out_.insert({placement.unit, placement.word}); }

 private:
  [[nodiscard]] bool has_aim() const {
    return limits_.cap == 0 && limits_.aim > 0 && options_.assign != AssignMethod::Sequential;
  }
  [[nodiscard]] bool is_within_limits(const WordPlan& plan, std::uint32_t redundancy) const;
  [[nodiscard]] std::vector<std::uint32_t> demand_of(std::uint32_t redundancy) const;
  [[nodiscard]] WordPlan solve(std::uint32_t redundancy);
  [[nodiscard]] std::vector<std::uint32_t> block_units(std::size_t block) const;
  void leave_out_far(std::span<const std::uint32_t> chosen);
  [[nodiscard]] const CostMatrix& block_costs(std::size_t block,
                                              std::span<const std::uint32_t> chosen);

  const BoundScheme& scheme_;
  const BoundScheme& moves_;
  const UnitSet& units_;
  std::span<const std::uint32_t> valid_;
  std::span<const Word> words_;
  std::size_t parts_;
  const MarkOptions& options_;
  MoveLimits limits_;
  std::size_t blocks_;
  std::size_t costs_of_block_;  // the block that costs_ holds
  CostMatrix costs_;
  std::set<std::pair<std::uint32_t, std::uint32_t>> ruled_out_;
};

}  // namespace triglyph
