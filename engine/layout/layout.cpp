#include "engine/layout/layout.h"

#include <algorithm>
#include <array>

#include "engine/base/error.h"

namespace triglyph {

namespace {

// by LayoutMethod
constexpr std::array<std::string_view, 6> kLayoutNames = {
    "first-fit", "min-degree", "static-degree", "random-degree", "ant-colony", "local-search"};

}  // namespace

std::span<const std::string_view> layout_names() {
  return kLayoutNames;
}

std::string_view name_of(LayoutMethod method) {
  return kLayoutNames.at(static_cast<std::size_t>(method));
}

LayoutMethod layout_method(const std::string& name) {
  const auto at = std::find(kLayoutNames.begin(), kLayoutNames.end(), name);
  if (at == kLayoutNames.end())
    throw Error(ErrorCode::Usage, {}, "", "unknown layout '" + name + "'");
  return static_cast<LayoutMethod>(at - kLayoutNames.begin());
}

std::vector<std::uint32_t> choose_layout(const Conflicts& conflicts, const LayoutOptions& options) {
  using Solver = std::vector<std::uint32_t> (*)(const Conflicts&, const LayoutOptions&);
  static constexpr std::array<Solver, kLayoutNames.size()> kSolvers = {
      first_fit_layout,     min_degree_layout, static_degree_layout,
      random_degree_layout, ant_colony_layout, local_search_layout};
  return kSolvers.at(static_cast<std::size_t>(options.method))(conflicts, options);
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
