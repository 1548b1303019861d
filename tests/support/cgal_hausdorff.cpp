#include "tests/support/cgal_hausdorff.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/distance.h>
#include <CGAL/Surface_mesh.h>

namespace triglyph::test {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using CgalMesh = CGAL::Surface_mesh<Kernel::Point_3>;

CgalMesh cgal_mesh_of(const Mesh& mesh) {
  CgalMesh result;
  for (const Vec3& p : mesh.positions) result.add_vertex(Kernel::Point_3(p[0], p[1], p[2]));
  const auto vertex = [](std::uint32_t point) { return CgalMesh::Vertex_index(point); };
  for (const Triangle& t : mesh.triangles) {
    result.add_face(vertex(t[0]), vertex(t[1]), vertex(t[2]));
  }
  return result;
}

}  // namespace

double cgal_hausdorff(const Mesh& first, const Mesh& second, double tolerance) {
  namespace Pmp = CGAL::Polygon_mesh_processing;
  return Pmp::bounded_error_symmetric_Hausdorff_distance<CGAL::Sequential_tag>(
      cgal_mesh_of(first), cgal_mesh_of(second), tolerance);
}

}  // namespace triglyph::test
