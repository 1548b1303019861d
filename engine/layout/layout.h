// Step 1 of the paper: a large set of candidates that do not interfere, an independent set of the
// conflict graph. Its size is the capacity of the mesh.
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
  FirstFit,      // un-optimised: every candidate, in order, that interferes with none taken before
  MinDegree,     // always the candidate with the fewest remaining neighbours
  StaticDegree,  // by degree in the whole graph
  RandomDegree,  // the paper's rule: drawn with a chance that falls with the degree; restarts
  AntColony,     // the paper's reference
  LocalSearch,   // swaps and uphill steps under a falling temperature
};

// "first-fit", "min-degree", "static-degree", "random-degree", "ant-colony", "local-search"; the
// inverse throws Error Usage.
[[nodiscard]] std::span<const std::string_view> layout_names();
[[nodiscard]] std::string_view name_of(LayoutMethod method);
[[nodiscard]] LayoutMethod layout_method(const std::string& name);

struct LayoutOptions {
  LayoutMethod method = LayoutMethod::MinDegree;
  // For the methods that search: about so many passes over the candidates (restarts, ants, steps a
  // unit), which gives the same layout every time; or as long as the clock allows, which does not.
  std::uint32_t iterations = 64;
  double seconds = 0;  // 0: by iterations
  std::uint64_t seed = 1;

  bool operator==(const LayoutOptions&) const = default;
};

// Units of a maximal independent set, ascending.
[[nodiscard]] std::vector<std::uint32_t> choose_layout(const Conflicts& conflicts,
                                                       const LayoutOptions& options);

// The solvers. O(total size of the units' neighbourhoods) a pass.
[[nodiscard]] std::vector<std::uint32_t> first_fit_layout(const Conflicts& conflicts,
                                                          const LayoutOptions& options = {});
[[nodiscard]] std::vector<std::uint32_t> static_degree_layout(const Conflicts& conflicts,
                                                              const LayoutOptions& options = {});
[[nodiscard]] std::vector<std::uint32_t> random_degree_layout(const Conflicts& conflicts,
                                                              const LayoutOptions& options = {});
[[nodiscard]] std::vector<std::uint32_t> ant_colony_layout(const Conflicts& conflicts,
                                                           const LayoutOptions& options = {});

// Greedy on dynamic degrees with a bucket queue, a neighbour counting once for every shared point;
// of equal degree, the unit that entered its bucket last. O(sum of degrees).
[[nodiscard]] std::vector<std::uint32_t> min_degree_layout(const Conflicts& conflicts,
                                                           const LayoutOptions& options = {});

// Never worse than min_degree_layout, where it starts. Writes the conflict graph out: 4 bytes an
// edge end. The same result for any number of threads.
[[nodiscard]] std::vector<std::uint32_t> local_search_layout(const Conflicts& conflicts,
                                                             const LayoutOptions& options = {});

// No independent set is larger: units move different points, so their sizes, smallest first, must
// fit into the points that candidates can move. O(units + points).
[[nodiscard]] std::uint32_t layout_bound(const Conflicts& conflicts);

}  // namespace triglyph
