// Meshes that tests share.
#pragma once

#include <cstddef>

#include "engine/mesh/halfedges.h"
#include "engine/mesh/mesh.h"
#include "engine/samples/sample_shapes.h"
#include "engine/scheme/scheme.h"

namespace triglyph::test {

// A mesh that keeps its connectivity beside it.
struct Solid {
  Mesh mesh;
  Halfedges halfedges;

  explicit Solid(Mesh source) : mesh(std::move(source)), halfedges(build_halfedges(mesh)) {}
  [[nodiscard]] Surface surface() const { return {mesh, halfedges}; }
};

inline Mesh tetrahedron() {
  return {{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)},
          {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
}

// Flat, (columns + 1) x (rows + 1) points one apart, every square cut along the same diagonal.
inline Mesh flat_grid(std::uint32_t columns, std::uint32_t rows) {
  Mesh mesh;
  for (std::uint32_t y = 0; y <= rows; ++y) {
    for (std::uint32_t x = 0; x <= columns; ++x) mesh.positions.emplace_back(x, y, 0);
  }
  const auto at = [&](std::uint32_t x, std::uint32_t y) { return y * (columns + 1) + x; };
  for (std::uint32_t y = 0; y < rows; ++y) {
    for (std::uint32_t x = 0; x < columns; ++x) {
      mesh.triangles.push_back({at(x, y), at(x + 1, y), at(x + 1, y + 1)});
      mesh.triangles.push_back({at(x, y), at(x + 1, y + 1), at(x, y + 1)});
    }
  }
  return mesh;
}

// A closed surface like a scan's, about 10,000 triangles.
inline const Solid& bumpy_ball() {
  static const Solid solid(make_sample_shape(SampleShape::Closed, 10000, 7));
  return solid;
}

// The same, for schemes whose units are large: about 60,000 triangles.
inline const Solid& large_ball() {
  static const Solid solid(make_sample_shape(SampleShape::Closed, 60000, 7));
  return solid;
}

}  // namespace triglyph::test
