// Step 1 of the paper: the layout, a large set of candidates that do not interfere. It is an
// independent set of the conflict graph, and its size is the capacity of the mesh.
// Wang & Hu, CAGD 27 (2010), section 2.1.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/layout/conflicts.h"

namespace triglyph {

enum class LayoutMethod {
  FirstFit,      // un-optimised: takes candidates in order unless they interfere with one taken
  MinDegree,     // greedy: takes the candidate with the fewest remaining neighbours
  StaticDegree,  // greedy by degree in the whole graph
  RandomDegree,  // the paper's rule: random order that favours low degree, with restarts
  AntColony,     // the algorithm that the paper refers to
  LocalSearch,   // simulated annealing with swaps
};

// Return the names in the order of LayoutMethod: "first-fit", "min-degree", "static-degree",
// "random-degree", "ant-colony", "local-search"; the name of a method; and the method of a name.
// layout_method() throws Error Usage for an unknown name.
[[nodiscard]] std::span<const std::string_view> layout_names();
[[nodiscard]] std::string_view name_of(LayoutMethod method);
[[nodiscard]] LayoutMethod layout_method(const std::string& name);

struct LayoutOptions {
  LayoutMethod method = LayoutMethod::MinDegree;
  // The methods that search make about this many passes over the candidates (restarts, ants, steps
  // per unit), which is reproducible; or search for `seconds`, which is not.
  std::uint32_t iterations = 64;
  double seconds = 0;      // 0: `iterations` applies
  std::uint64_t seed = 1;  // of the random numbers

  bool operator==(const LayoutOptions&) const = default;
};

// Returns the units of a maximal independent set, ascending, found by the method of the options.
[[nodiscard]] std::vector<std::uint32_t> choose_layout(const Conflicts& conflicts,
                                                       const LayoutOptions& options);

// The solvers, with results as for choose_layout(). O(sum of degrees) per pass.
[[nodiscard]] std::vector<std::uint32_t> first_fit_layout(const Conflicts& conflicts,
                                                          const LayoutOptions& options = {});
[[nodiscard]] std::vector<std::uint32_t> static_degree_layout(const Conflicts& conflicts,
                                                              const LayoutOptions& options = {});
[[nodiscard]] std::vector<std::uint32_t> random_degree_layout(const Conflicts& conflicts,
                                                              const LayoutOptions& options = {});
[[nodiscard]] std::vector<std::uint32_t> ant_colony_layout(const Conflicts& conflicts,
                                                           const LayoutOptions& options = {});

// Greedy solver on dynamic degrees with a bucket queue. A neighbour counts once for every shared
// point; ties go to the unit that entered its bucket last. O(sum of degrees).
[[nodiscard]] std::vector<std::uint32_t> min_degree_layout(const Conflicts& conflicts,
                                                           const LayoutOptions& options = {});

// Local search that starts from min_degree_layout() and never returns a smaller layout. Builds the
// explicit conflict graph, 8 bytes per edge. The result is the same for any number of threads.
[[nodiscard]] std::vector<std::uint32_t> local_search_layout(const Conflicts& conflicts,
                                                             const LayoutOptions& options = {});

// Returns an upper bound of the size of any layout: units move disjoint sets of points, so their
// sizes, smallest first, must fit into the points that candidates can move. O(units + points).
[[nodiscard]] std::uint32_t layout_bound(const Conflicts& conflicts);

}  // namespace triglyph
