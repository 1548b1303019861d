#include "engine/attack/isotropic_remesh.h"

#include <array>
#include <cstdlib>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

#include "engine/attack/stored_mesh.h"
#include "engine/base/error.h"
#include "engine/base/parallel.h"
#include "engine/base/stop.h"
#include "engine/geometry/spatial_index.h"
#include "engine/mesh/halfedges.h"

namespace triglyph {
namespace {

using OpenMesh::EdgeHandle;
using OpenMesh::FaceHandle;
using OpenMesh::HalfedgeHandle;
using OpenMesh::VertexHandle;

constexpr int kRounds = 5;
constexpr double kLongest = 4.0 / 3;   // of the edge length; longer edges are split
constexpr double kShortest = 4.0 / 5;  // shorter ones are collapsed

class Remesher {
 public:
  Remesher(const Mesh& mesh, double edge_length)
      : surface_(mesh.positions, mesh.triangles), length_(edge_length), points_(mesh.positions) {
    const Halfedges halfedges = build_halfedges(mesh);
    kernel_ = halfedges.kernel();
    for (const std::uint32_t point : halfedges.copied_points()) {
      points_.push_back(mesh.positions[point]);
    }
    kernel_.request_vertex_status();
    kernel_.request_halfedge_status();
    kernel_.request_edge_status();
    kernel_.request_face_status();
  }

  void run_round() {
    split_long_edges();
    collapse_short_edges();
    even_out_valences();
    relax();
  }

  [[nodiscard]] Mesh result() const {
    std::vector<Triangle> triangles;
    for (int f = 0; f < count(kernel_.n_faces()); ++f) {
      const FaceHandle face(f);
      if (kernel_.status(face).deleted()) continue;
      HalfedgeHandle side = kernel_.halfedge_handle(face);
      Triangle t{};
      for (std::uint32_t& corner : t) {
        corner = static_cast<std::uint32_t>(kernel_.to_vertex_handle(side).idx());
        side = kernel_.next_halfedge_handle(side);
      }
      triangles.push_back(t);
    }
    return compacted(points_, triangles);
  }

 private:
  static int count(std::size_t n) { return static_cast<int>(n); }
  [[nodiscard]] const Vec3& at(VertexHandle v) const {
    return points_[static_cast<std::size_t>(v.idx())];
  }
  [[nodiscard]] Vec3& at(VertexHandle v) { return points_[static_cast<std::size_t>(v.idx())]; }
  [[nodiscard]] VertexHandle start(HalfedgeHandle h) const { return kernel_.from_vertex_handle(h); }
  [[nodiscard]] VertexHandle end(HalfedgeHandle h) const { return kernel_.to_vertex_handle(h); }
  [[nodiscard]] double length_of(EdgeHandle e) const {
    const HalfedgeHandle h = kernel_.halfedge_handle(e, 0);
    return (at(end(h)) - at(start(h))).norm();
  }
  // Calls body for every halfedge that leaves the vertex.
  template <typename Body>
  void around(VertexHandle v, const Body& body) const {
    for (auto h = kernel_.cvoh_iter(v); h.is_valid(); ++h) body(HalfedgeHandle(*h));
  }
  // The normal, as long as twice the area, of the face at a halfedge, as if its start were at `p`.
  [[nodiscard]] Vec3 normal_with(HalfedgeHandle h, const Vec3& p) const {
    return area_normal(p, at(end(h)), at(end(kernel_.next_halfedge_handle(h))));
  }

  // The longest first: the edges to the opposite corners are then shorter, so that this ends.
  void split_long_edges() {
    using Long = std::pair<double, int>;  // length, edge
    std::priority_queue<Long> waiting;
    const auto look_at = [&](int edge) {
      const EdgeHandle e(edge);
      if (kernel_.status(e).deleted()) return;
      if (const double length = length_of(e); length > kLongest * length_) {
        waiting.emplace(length, edge);
      }
    };
    for (int i = 0; i < count(kernel_.n_edges()); ++i) look_at(i);
    while (!waiting.empty()) {
      const EdgeHandle e(waiting.top().second);
      waiting.pop();
      stop_point();
      check(points_.size() < std::size_t{1} << 28U, "the edges asked for are not that short");
      const HalfedgeHandle h = kernel_.halfedge_handle(e, 0);
      const Vec3 middle = (at(start(h)) + at(end(h))) / 2;
      const VertexHandle v = kernel_.add_vertex();
      points_.push_back(middle);
      kernel_.split(e, v);
      around(v, [&](HalfedgeHandle spoke) { look_at(kernel_.edge_handle(spoke).idx()); });
    }
  }

  // Where the collapse of an edge would leave its point: at the end that lies on a border, else in
  // the middle.
  [[nodiscard]] Vec3 place_of_collapse(HalfedgeHandle h) const {
    const bool from_border = kernel_.is_boundary(start(h));
    if (from_border == kernel_.is_boundary(end(h))) return (at(start(h)) + at(end(h))) / 2;
    return from_border ? at(start(h)) : at(end(h));
  }

  // Would no edge become too long and no face turn over if the start of h moved to p, and the faces
  // at h were gone?
  [[nodiscard]] bool can_move(HalfedgeHandle h, const Vec3& p) const {
    const VertexHandle from = start(h);
    const VertexHandle to = end(h);
    bool fine = true;
    around(from, [&](HalfedgeHandle spoke) {
      fine = fine && (at(end(spoke)) - p).norm() <= kLongest * length_;
      if (kernel_.is_boundary(spoke)) return;
      const VertexHandle third = end(kernel_.next_halfedge_handle(spoke));
      if (end(spoke) == to || third == to) return;
      fine = fine && dot(normal_with(spoke, at(from)), normal_with(spoke, p)) > 0;
    });
    return fine;
  }

  void collapse_short_edges() {
    for (int i = 0; i < count(kernel_.n_edges()); ++i) {
      const EdgeHandle e(i);
      if (kernel_.status(e).deleted() || length_of(e) >= kShortest * length_) continue;
      stop_point();
      const HalfedgeHandle h = kernel_.halfedge_handle(e, 0);
      const bool joins_borders = kernel_.is_boundary(start(h)) && kernel_.is_boundary(end(h));
      if (joins_borders && !kernel_.is_boundary(e)) continue;
      const Vec3 place = place_of_collapse(h);
      const HalfedgeHandle back = kernel_.opposite_halfedge_handle(h);
      if (!can_move(h, place) || !can_move(back, place) || !kernel_.is_collapse_ok(h)) continue;
      at(end(h)) = place;
      kernel_.collapse(h);
    }
  }

  // How far the number of edges at a vertex is from six, or from four on a border, when it changes.
  [[nodiscard]] int excess(VertexHandle v, int change) const {
    const int valence = static_cast<int>(kernel_.valence(v)) + change;
    return std::abs(valence - (kernel_.is_boundary(v) ? 4 : 6));
  }

  // The two faces at an inner edge from a to b are a b c and b a d; turned, they are c a d and d b
  // c.
  void even_out_valences() {
    for (int i = 0; i < count(kernel_.n_edges()); ++i) {
      const EdgeHandle e(i);
      if (kernel_.status(e).deleted() || kernel_.is_boundary(e)) continue;
      const HalfedgeHandle h = kernel_.halfedge_handle(e, 0);
      const VertexHandle a = start(h);
      const VertexHandle b = end(h);
      const VertexHandle c = end(kernel_.next_halfedge_handle(h));
      const VertexHandle d = end(kernel_.next_halfedge_handle(kernel_.opposite_halfedge_handle(h)));
      const int before = excess(a, 0) + excess(b, 0) + excess(c, 0) + excess(d, 0);
      const int after = excess(a, -1) + excess(b, -1) + excess(c, 1) + excess(d, 1);
      if (after >= before || !kernel_.is_flip_ok(e)) continue;
      const Vec3 normal = area_normal(at(a), at(b), at(c)) + area_normal(at(b), at(a), at(d));
      if (dot(area_normal(at(c), at(a), at(d)), normal) <= 0) continue;
      if (dot(area_normal(at(d), at(b), at(c)), normal) <= 0) continue;
      kernel_.flip(e);
    }
  }

  [[nodiscard]] Vec3 relaxed(VertexHandle v) const {
    Vec3 mean(0, 0, 0);
    Vec3 normal(0, 0, 0);
    double neighbours = 0;
    around(v, [&](HalfedgeHandle spoke) {
      mean += at(end(spoke));
      neighbours += 1;
      normal += normal_with(spoke, at(v));
    });
    const Vec3 step = mean / neighbours - at(v);
    const double size = normal.sqrnorm();
    return size > 0 ? at(v) + step - dot(step, normal) / size * normal : at(v);
  }

  void relax() {
    std::vector<Vec3> moved = points_;
    parallel_for(
        points_.size(),
        [&](std::size_t i) {
          const VertexHandle v(static_cast<int>(i));
          const bool is_free =
              !kernel_.status(v).deleted() && !kernel_.is_isolated(v) && !kernel_.is_boundary(v);
          if (!is_free) return;
          const ClosestPoint closest =
              surface_.closest(relaxed(v), std::numeric_limits<double>::infinity());
          if (closest.triangle != kNoTriangle) moved[i] = closest.point;
        },
        512);
    points_ = std::move(moved);
  }

  SpatialIndex surface_;
  double length_;  // model units
  OpenMesh::TriConnectivity kernel_;
  std::vector<Vec3> points_;  // by vertex of the kernel
};

}  // namespace

Mesh remeshed_isotropically(const Mesh& mesh, double edge_length) {
  if (mesh.triangles.empty() || !(edge_length > 0)) return mesh;
  Remesher remesher(mesh, edge_length);
  for (int round = 0; round < kRounds; ++round) remesher.run_round();
  return remesher.result();
}

}  // namespace triglyph
