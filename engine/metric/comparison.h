// The metrics by name: all measures of the difference between two meshes.
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

// Returns "hausdorff", "displacement", "metro", "mrms", "msdm", "msdm2", "roughness", "strain",
// "normal", "snr". The headers of this folder define them.
[[nodiscard]] std::span<const std::string_view> metric_names();

// Returns whether a metric compares two positions of the same triangles.
[[nodiscard]] bool needs_same_triangles(std::string_view metric);

// Returns whether the meshes have as many points and equal triangles. O(triangles).
[[nodiscard]] bool have_same_triangles(const Mesh& first, const Mesh& second);

// Returns the values of a metric, distances in model units. `hausdorff_tolerance` is a share of the
// diagonal of the first mesh's bounding box. Throws Error Usage for an unknown metric, for a mesh
// without faces, and if the metric needs the same triangles and the meshes differ in them.
[[nodiscard]] std::vector<NamedValue> compare(const Mesh& first, const Mesh& second,
                                              std::string_view metric,
                                              double hausdorff_tolerance = kHausdorffTolerance);

}  // namespace triglyph
