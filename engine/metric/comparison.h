// All measures of two meshes by name.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/mesh/mesh.h"
#include "engine/metric/hausdorff.h"

namespace triglyph {

struct NamedValue {
  std::string name;
  double value = 0;
};

// "hausdorff", "displacement", "metro", "mrms", "msdm", "msdm2", "roughness", "strain", "normal",
// "snr"; each header says what they are.
[[nodiscard]] std::span<const std::string_view> metric_names();

// Does it need two positions of the same triangles?
[[nodiscard]] bool needs_same_triangles(std::string_view metric);
[[nodiscard]] bool have_same_triangles(const Mesh& first, const Mesh& second);

// What a metric says of two meshes, distances in model units. `hausdorff_tolerance` is a share of
// the diagonal of the first mesh's box. Throws Error Usage for an unknown name, for a mesh without
// faces, and for a metric that needs the same triangles where they are not.
[[nodiscard]] std::vector<NamedValue> compare(const Mesh& first, const Mesh& second,
                                              std::string_view metric,
                                              double hausdorff_tolerance = kHausdorffTolerance);

}  // namespace triglyph
