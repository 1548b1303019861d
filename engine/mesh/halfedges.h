// Connectivity of a mesh as an OpenMesh halfedge kernel. Built in bulk from the triangles instead
// of face by face, so that no face is refused: where the surface is not manifold it is cut open in
// the kernel, and the points stay as they are.
#pragma once

#include <cstdint>
#include <vector>

#include <OpenMesh/Core/Mesh/TriConnectivity.hh>

#include "engine/mesh/mesh.h"

namespace triglyph {

// Face f of the kernel is triangle f of the mesh, and its first halfedge runs from the triangle's
// first corner to its second. An edge with other than two faces, or with two faces that run along
// it in the same direction, is a boundary edge of each. A point at which several fans of triangles
// touch has one kernel vertex a fan: vertices 0 .. points - 1 are the points themselves (their
// first fan), the copies follow.
struct Halfedges {
  OpenMesh::TriConnectivity kernel;
  std::vector<std::uint32_t> copied_point;  // point of vertex points + i

  [[nodiscard]] std::uint32_t point(OpenMesh::VertexHandle vertex) const {
    const auto index = static_cast<std::uint32_t>(vertex.idx());
    const auto points = static_cast<std::uint32_t>(kernel.n_vertices() - copied_point.size());
    return index < points ? index : copied_point[index - points];
  }
};

// O(triangles) for bounded vertex degrees, O(t log t) at worst.
[[nodiscard]] Halfedges build_halfedges(const Mesh& mesh);

}  // namespace triglyph
