// Connectivity of a mesh as halfedges. The only header that names OpenMesh, whose kernel it wraps.
// The kernel is built in bulk from the triangles instead of face by face, so that no face is
// refused: the connectivity is cut open where the surface is not manifold, and the points stay as
// they are.
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
// its second. An edge becomes a boundary edge of each of its faces if it has other than two of
// them, or two that traverse it in the same direction. A point where several fans of triangles meet
// gets one vertex per fan: vertices 0 .. points - 1 are the points themselves, with their first
// fan; the copies for further fans follow. All member functions take O(1).
class Halfedges {
 public:
  [[nodiscard]] std::uint32_t face_count() const {
    return static_cast<std::uint32_t>(kernel_.n_faces());
  }
  [[nodiscard]] std::uint32_t edge_count() const {
    return static_cast<std::uint32_t>(kernel_.n_edges());
  }
  // Returns the number of points and of their copies.
  [[nodiscard]] std::uint32_t vertex_count() const {
    return static_cast<std::uint32_t>(kernel_.n_vertices());
  }
  // Returns the point of every copy, by ascending vertex.
  [[nodiscard]] std::span<const std::uint32_t> copied_points() const { return copied_points_; }

  [[nodiscard]] Halfedge first_of_face(std::uint32_t face) const {
    return wrap(kernel_.halfedge_handle(OpenMesh::FaceHandle(static_cast<int>(face))));
  }
  // Returns one of the two halfedges, `side` 0 or 1, of an edge. Side 0 always has a face, side 1
  // only if the edge is interior.
  [[nodiscard]] Halfedge of_edge(std::uint32_t edge, std::uint32_t side) const {
    return static_cast<Halfedge>(2 * edge + side);
  }
  // Returns a halfedge that leaves the vertex: its boundary halfedge if there is one, kNoHalfedge
  // if no face uses the vertex.
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
  // Returns the next halfedge, counter-clockwise, that leaves the same vertex.
  [[nodiscard]] Halfedge turned(Halfedge halfedge) const { return opposite(previous(halfedge)); }

  // Returns whether the halfedge has no face.
  [[nodiscard]] bool is_boundary(Halfedge halfedge) const {
    return kernel_.is_boundary(handle(halfedge));
  }
  // Returns the face to the left. Precondition: not a boundary halfedge.
  [[nodiscard]] std::uint32_t face(Halfedge halfedge) const {
    return static_cast<std::uint32_t>(kernel_.face_handle(handle(halfedge)).idx());
  }
  [[nodiscard]] std::uint32_t edge(Halfedge halfedge) const {
    return static_cast<std::uint32_t>(halfedge) / 2;
  }

  // Return the points where the halfedge starts and ends.
  [[nodiscard]] std::uint32_t from(Halfedge halfedge) const { return to(opposite(halfedge)); }
  [[nodiscard]] std::uint32_t to(Halfedge halfedge) const { return point(to_vertex(halfedge)); }

  // Returns the connectivity in OpenMesh's terms, for those who change a copy of it.
  [[nodiscard]] const OpenMesh::TriConnectivity& kernel() const { return kernel_; }

  // Returns the vertex where the halfedge ends: a point, or a copy of one.
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

// Returns the connectivity of the mesh. O(triangles) for bounded vertex degrees, O(t log t) at
// worst.
[[nodiscard]] Halfedges build_halfedges(const Mesh& mesh);

}  // namespace triglyph
