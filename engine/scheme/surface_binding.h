// Common part of the bound schemes: the surface, the local cost on it and the loop over placements.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/base/once.h"
#include "engine/base/parallel.h"
#include "engine/mesh/edge_length.h"
#include "engine/scheme/local_cost.h"
#include "engine/scheme/scheme.h"
#include "engine/scheme/scheme_options.h"

namespace triglyph {

class SurfaceBinding : public BoundScheme {
 public:
  // O(triangles).
  [[nodiscard]] double cell_size() const final {
    return options_.step * mean_edge_length(surface_.mesh);
  }

 protected:
  // The mesh, the halfedges and the options, which are the scheme's, must outlive the binding.
  SurfaceBinding(const Surface& surface, const SchemeOptions& options)
      : surface_(surface), options_(options) {}

  [[nodiscard]] const Surface& surface() const { return surface_; }
  [[nodiscard]] const Mesh& mesh() const { return surface_.mesh; }

  // The cost function of the options; made when it is first asked for.
  [[nodiscard]] const LocalCost& local_cost() const {
    return local_cost_.get([&] { return LocalCost(surface_, options_.cost); });
  }

  // Embeds `count` placements in parallel. embed_unit(i, positions) moves the points of placement i
  // among the positions, which start out as the surface's, or returns false and moves none; it must
  // be safe to call for several placements at a time.
  template <typename EmbedUnit>
  [[nodiscard]] Embedding embed_each(std::size_t count, const EmbedUnit& embed_unit) const {
    constexpr std::size_t kUnitsPerTask = 4;  // iie's units are dear, and some far dearer
    Embedding embedding{surface_.mesh.positions, {}};
    std::vector<char> embedded(count);
    parallel_for(
        count, [&](std::size_t i) { embedded[i] = embed_unit(i, embedding.positions) ? 1 : 0; },
        kUnitsPerTask);
    for (std::uint32_t i = 0; i < count; ++i) {
      if (embedded[i] == 0) embedding.failed.push_back(i);
    }
    return embedding;
  }

 private:
  const Surface surface_;
  const SchemeOptions& options_;
  Once<LocalCost> local_cost_;
};

}  // namespace triglyph
