#include "engine/layout/conflicts.h"

#include <array>

namespace triglyph {
namespace {

constexpr std::array<std::string_view, 2> kRuleNames = {"read-write", "shared-point"};

// Returns the lists of the units at each point, ascending.
PointLists transpose(const PointLists& lists, std::size_t points) {
  PointLists result;
  result.offsets.assign(points + 1, 0);
  result.points.resize(lists.points.size());
  for (const std::uint32_t point : lists.points) ++result.offsets[point + 1];
  for (std::size_t i = 0; i < points; ++i) result.offsets[i + 1] += result.offsets[i];
  std::vector<std::uint32_t> cursor(result.offsets.begin(), result.offsets.end() - 1);
  for (std::uint32_t unit = 0; unit < lists.size(); ++unit) {
    for (const std::uint32_t point : lists[unit]) result.points[cursor[point]++] = unit;
  }
  return result;
}

}  // namespace

std::span<const std::string_view> conflict_names() {
  return kRuleNames;
}

std::string_view name_of(ConflictRule rule) {
  return kRuleNames.at(static_cast<std::size_t>(rule));
}

Conflicts::Conflicts(const PointLists& moved, const PointLists& read, std::size_t points,
                     ConflictRule rule)
    : moved_(rule == ConflictRule::SharedPoint ? &read : &moved),
      read_(&read),
      movers_(transpose(*moved_, points)) {
  if (moved_ != read_) readers_ = transpose(*read_, points);
}

}  // namespace triglyph
