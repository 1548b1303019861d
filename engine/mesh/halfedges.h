// Connectivity of a mesh: halfedges over an OpenMesh kernel, which no other header names. Built in
// bulk from the triangles instead of face by face, so that no face is refused: where the surface is
// not manifold the kernel is cut open, and the points stay as they are.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <OpenMesh/Core/Mesh/TriConnectivity.hh>

#include "engine/mesh/mesh.h"

namespace triglyph {

// One side of an edge. Edge e has the halfedges 2e and 2e + 1.
enum class Halfedge : std::int32_t {};

inline constexpr Halfedge kNoHalfedge{-1};

// Face f is triangle f of the mesh, and its first halfedge runs from the triangle's first corner to
// its second. An edge with other than two faces, or with two faces that run along it in the same
// direction, is a boundary edge of each. A point at which several fans of triangles touch has one
// vertex a fan: vertices 0 .. points - 1 are the points themselves (their first fan), the copies
// follow. All members take O(1).
class Halfedges {
 public:
  [[nodiscard]] std::uint32_t face_count() const {
    return static_cast<std::uint32_t>(kernel_.n_faces());
  }
  [[nodiscard]] std::uint32_t edge_count() const {
    return static_cast<std::uint32_t>(kernel_.n_edges());
  }
  // Points and the copies of points at which several fans touch.
  [[nodiscard]] std::uint32_t vertex_count() const {
    return static_cast<std::uint32_t>(kernel_.n_vertices());
  }
  // The point of each vertex that is a copy, by ascending vertex.
  [[nodiscard]] std::span<const std::uint32_t> copied_points() const { return copied_points_; }

  [[nodiscard]] Halfedge first_of_face(std::uint32_t face) const {
    return wrap(kernel_.halfedge_handle(OpenMesh::FaceHandle(static_cast<int>(face))));
  }
  // `side` 0 or 1. Of an interior edge both have a face, of a boundary edge the first.
  [[nodiscard]] Halfedge of_edge(std::uint32_t edge, std::uint32_t side) const {
    return static_cast<Halfedge>(2 * edge + side);
  }
  // One that leaves the vertex, its boundary halfedge if it has one; kNoHalfedge: no face uses it.
  [[nodiscard]] Halfedge outgoing(std::uint32_t vertex) const {
    return wrap(kernel_.halfedge_handle(OpenMesh::VertexHandle(static_cast<int>(vertex))));
  }

  [[nodiscard]] Halfedge next(Halfedge halfedge) const {
    return wrap(kernel_.next_halfedge_handle(handle(halfedge)));
  }
  [[nodiscard]] Halfedge previous(Halfedge halfedge) const {
    return wrap(kernel_.prev_halfedge_handle(handle(halfedge)));
  }
  [[nodiscard]] Halfedge opposite(Halfedge halfedge) const {
    return static_cast<Halfedge>(static_cast<std::int32_t>(halfedge) ^ 1);
  }
  // The next halfedge that leaves the same vertex, counter-clockwise.
  [[nodiscard]] Halfedge turned(Halfedge halfedge) const { return opposite(previous(halfedge)); }

  // Does it lie outside the surface, with no face?
  [[nodiscard]] bool is_boundary(Halfedge halfedge) const {
    return kernel_.is_boundary(handle(halfedge));
  }
  // The face to its left. Precondition: not at the boundary.
  [[nodiscard]] std::uint32_t face(Halfedge halfedge) const {
    return static_cast<std::uint32_t>(kernel_.face_handle(handle(halfedge)).idx());
  }
  [[nodiscard]] std::uint32_t edge(Halfedge halfedge) const {
    return static_cast<std::uint32_t>(halfedge) / 2;
  }

  // The points it runs between.
  [[nodiscard]] std::uint32_t from(Halfedge halfedge) const { return to(opposite(halfedge)); }
  [[nodiscard]] std::uint32_t to(Halfedge halfedge) const { return point(to_vertex(halfedge)); }

  // The vertex it runs to: its point, or a copy of it.
  [[nodiscard]] std::uint32_t to_vertex(Halfedge halfedge) const {
    return static_cast<std::uint32_t>(kernel_.to_vertex_handle(handle(halfedge)).idx());
  }

 private:
  friend Halfedges build_halfedges(const Mesh& mesh);

  [[nodiscard]] static OpenMesh::HalfedgeHandle handle(Halfedge halfedge) {
    return OpenMesh::HalfedgeHandle(static_cast<int>(halfedge));
  }
  [[nodiscard]] static Halfedge wrap(OpenMesh::HalfedgeHandle halfedge) {
    return static_cast<Halfedge>(halfedge.idx());
  }
  [[nodiscard]] std::uint32_t point(std::uint32_t vertex) const {
    const auto points = static_cast<std::uint32_t>(vertex_count() - copied_points_.size());
    return vertex < points ? vertex : copied_points_[vertex - points];
  }

  OpenMesh::TriConnectivity kernel_;
  std::vector<std::uint32_t> copied_points_;
};

// O(triangles) for bounded vertex degrees, O(t log t) at worst.
[[nodiscard]] Halfedges build_halfedges(const Mesh& mesh);

}  // namespace triglyph
