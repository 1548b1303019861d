#include "engine/layout/layout.h"

#include <algorithm>

#include "engine/base/error.h"

namespace triglyph {

std::string_view name_of(LayoutMethod method) {
  return method == LayoutMethod::FirstFit ? "first-fit" : "min-degree";
}

LayoutMethod layout_method(const std::string& name) {
  for (const LayoutMethod method : {LayoutMethod::FirstFit, LayoutMethod::MinDegree}) {
    if (name == name_of(method)) return method;
  }
  throw Error(ErrorCode::Usage, {}, "", "unknown layout '" + name + "'");
}

std::vector<std::uint32_t> choose_layout(const Conflicts& conflicts, LayoutMethod method) {
  return method == LayoutMethod::FirstFit ? first_fit_layout(conflicts)
                                          : min_degree_layout(conflicts);
}

std::uint32_t layout_bound(const Conflicts& conflicts) {
  std::vector<char> movable(conflicts.points(), 0);
  std::vector<std::uint32_t> units_of_size;
  for (std::uint32_t unit = 0; unit < conflicts.size(); ++unit) {
    const auto moved = conflicts.moved(unit);
    if (units_of_size.size() <= moved.size()) units_of_size.resize(moved.size() + 1, 0);
    ++units_of_size[moved.size()];
    for (const std::uint32_t point : moved) movable[point] = 1;
  }
  auto room = static_cast<std::size_t>(std::count(movable.begin(), movable.end(), 1));
  std::uint32_t bound = 0;
  for (std::size_t size = 1; size < units_of_size.size(); ++size) {
    const std::size_t fitting = std::min<std::size_t>(units_of_size[size], room / size);
    bound += static_cast<std::uint32_t>(fitting);
    room -= fitting * size;
  }
  return bound;
}

}  // namespace triglyph
