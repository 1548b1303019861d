// The cotangent Laplacian's weights, kept within bounds.
#pragma once

#include <vector>

#include "engine/mesh/mesh.h"

namespace triglyph {

// Returns the area of each point, a third of that of its faces, squared model units; at least a
// thousandth of the mean, so that no point is without. O(triangles).
[[nodiscard]] std::vector<double> point_areas(const Mesh& mesh);

// Returns half the cotangent of the angle at `apex`, the weight of the edge across. Slivers neither
// vanish nor dominate: the cotangent is kept within 0.02 and 20.
[[nodiscard]] double cotangent_weight(const Vec3& apex, const Vec3& a, const Vec3& b);

}  // namespace triglyph
