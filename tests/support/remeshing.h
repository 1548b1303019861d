// Other tessellations of a shape, by OpenMesh's tools. Precondition: the mesh is manifold.
#pragma once

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>
#include <OpenMesh/Tools/Smoother/JacobiLaplaceSmootherT.hh>

#include "engine/mesh/mesh.h"

namespace triglyph::test {

struct DoubleTraits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
  using Normal = OpenMesh::Vec3d;
};
using Workpiece = OpenMesh::TriMesh_ArrayKernelT<DoubleTraits>;

inline Workpiece workpiece_of(const Mesh& mesh) {
  Workpiece piece;
  for (const Vec3& p : mesh.positions) piece.add_vertex({p[0], p[1], p[2]});
  for (const Triangle& t : mesh.triangles) {
    piece.add_face(piece.vertex_handle(t[0]), piece.vertex_handle(t[1]), piece.vertex_handle(t[2]));
  }
  return piece;
}

inline Mesh mesh_of(const Workpiece& piece) {
  Mesh mesh;
  for (const auto vertex : piece.vertices()) {
    const auto& p = piece.point(vertex);
    mesh.positions.emplace_back(p[0], p[1], p[2]);
  }
  for (const auto face : piece.faces()) {
    Triangle triangle{};
    std::size_t i = 0;
    for (const auto vertex : piece.fv_range(face)) {
      triangle[i++] = static_cast<std::uint32_t>(vertex.idx());
    }
    mesh.triangles.push_back(triangle);
  }
  return mesh;
}

inline Mesh smoothed(const Mesh& mesh) {
  Workpiece piece = workpiece_of(mesh);
  OpenMesh::Smoother::JacobiLaplaceSmootherT<Workpiece> smoother(piece);
  using Base = OpenMesh::Smoother::SmootherT<Workpiece>;
  smoother.initialize(Base::Tangential_and_Normal, Base::C0);
  smoother.smooth(1);
  return mesh_of(piece);
}

inline Mesh decimated(const Mesh& mesh, double share_removed) {
  Workpiece piece = workpiece_of(mesh);
  OpenMesh::Decimater::DecimaterT<Workpiece> decimater(piece);
  OpenMesh::Decimater::ModQuadricT<Workpiece>::Handle quadric;
  decimater.add(quadric);
  decimater.initialize();
  decimater.decimate(static_cast<std::size_t>(share_removed * double(mesh.positions.size())));
  piece.garbage_collection();
  return mesh_of(piece);
}

}  // namespace triglyph::test
