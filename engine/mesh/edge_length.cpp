#include "engine/mesh/edge_length.h"

#include "engine/base/parallel.h"

namespace triglyph {

double mean_edge_length(const Mesh& mesh) {
  const double total = parallel_reduce(
      mesh.triangles.size(), 0.0,
      [&](std::size_t t) {
        const Triangle& triangle = mesh.triangles[t];
        double sum = 0;
        for (std::size_t i = 0; i < 3; ++i) {
          sum += (mesh.positions[triangle[(i + 1) % 3]] - mesh.positions[triangle[i]]).norm();
        }
        return sum;
      },
      [](double a, double b) { return a + b; });
  return mesh.triangles.empty() ? 0 : total / (3.0 * static_cast<double>(mesh.triangles.size()));
}

}  // namespace triglyph
