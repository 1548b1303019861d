#include "engine/marking/select_units.h"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "engine/marking/mark.h"
#include "engine/scheme/registry.h"
#include "tests/support/shapes.h"

namespace triglyph {
namespace {

class FindCapacity : public testing::Test {
 protected:
  MarkOptions options_ = default_mark_options("tsq", true);
  WordCode code_{Key::trial(), options_.format};
  std::unique_ptr<Scheme> scheme_ = make_scheme("tsq", code_, options_.scheme_options);
  std::unique_ptr<BoundScheme> bound_ = scheme_->bind(test::bumpy_ball().surface());
  std::vector<Word> words_ = code_.fill_words(kProbeWords);

  [[nodiscard]] Capacity capacity(double drop_dearest) {
    options_.drop_dearest_percent = 100 * drop_dearest;
    return find_capacity(test::bumpy_ball().surface(), *bound_, words_, options_);
  }
  // Of every candidate, by anchor.
  [[nodiscard]] std::vector<std::pair<std::uint32_t, float>> cheapest(const UnitSet& units) const {
    std::vector<std::uint32_t> all(units.size());
    for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
    const CostMatrix costs = bound_->costs(units, all, words_);
    std::vector<std::pair<std::uint32_t, float>> found;
    for (const std::uint32_t unit : all) {
      float least = kInfeasible;
      for (std::uint32_t word = 0; word < costs.words; ++word) {
        least = std::min(least, costs.at(unit, word));
      }
      found.emplace_back(units.anchors[unit], least);
    }
    return found;
  }
};

TEST_F(FindCapacity, LeavesOutTheDearestCandidatesOnly) {
  const Capacity whole = capacity(0);
  const Capacity part = capacity(0.3);
  const std::size_t dropped = whole.units.size() * 3 / 10;
  EXPECT_EQ(part.units.size(), whole.units.size() - dropped);
  EXPECT_LT(part.valid.size(), whole.valid.size());
  EXPECT_LE(part.valid.size(), part.bound);
  const std::set<std::uint32_t> kept(part.units.anchors.begin(), part.units.anchors.end());
  EXPECT_TRUE(std::is_sorted(part.units.anchors.begin(), part.units.anchors.end()));
  float dearest_kept = 0, cheapest_dropped = kInfeasible;
  for (const auto& [anchor, cost] : cheapest(whole.units)) {
    if (kept.count(anchor) != 0) {
      dearest_kept = std::max(dearest_kept, cost);
    } else {
      cheapest_dropped = std::min(cheapest_dropped, cost);
    }
  }
  EXPECT_LE(dearest_kept, cheapest_dropped);
}

TEST_F(FindCapacity, RefusesAShareThatCannotBe) {
  EXPECT_THROW((void)capacity(1), Error);
  EXPECT_THROW((void)capacity(-0.1), Error);
}

TEST_F(FindCapacity, KeepsTheSubscriptBitsItIsTold) {
  const auto format_of = [&](bool keeps) {
    options_.drop_dearest_percent = 0;
    options_.keeps_subscript_bits = keeps;
    return mark(
               test::bumpy_ball().surface(), Fill{}, Key::trial(), options_,
               [](const Vec3& p) { return p; }, 0)
        .format;
  };
  EXPECT_EQ(format_of(true), options_.format);
  EXPECT_LT(format_of(false).subscript_bits, options_.format.subscript_bits);
}

}  // namespace
}  // namespace triglyph
