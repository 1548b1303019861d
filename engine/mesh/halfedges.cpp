#include "engine/mesh/halfedges.h"

#include <algorithm>

#include "engine/base/parallel.h"

namespace triglyph {
namespace {

using OpenMesh::FaceHandle;
using OpenMesh::HalfedgeHandle;
using OpenMesh::VertexHandle;

// Index 3t + i of the i-th corner of triangle t, and of the directed edge that starts there.
using Corner = std::uint32_t;
constexpr Corner kNone = 0xffffffff;

Corner next(Corner corner) {
  return corner % 3 == 2 ? corner - 2 : corner + 1;
}
Corner previous(Corner corner) {
  return corner % 3 == 0 ? corner + 2 : corner - 1;
}

struct Corners {
  const Mesh& mesh;
  std::vector<Corner> opposite;  // kNone on a boundary

  [[nodiscard]] std::uint32_t start(Corner corner) const {
    return mesh.triangles[corner / 3][corner % 3];
  }
  [[nodiscard]] std::uint32_t end(Corner corner) const { return start(next(corner)); }
  [[nodiscard]] Corner count() const { return static_cast<Corner>(opposite.size()); }
};

// A directed edge, listed at its lower point.
struct Spoke {
  std::uint32_t other;
  Corner corner;

  bool operator<(const Spoke& spoke) const {
    return other != spoke.other ? other < spoke.other : corner < spoke.corner;
  }
};

// Pairs the directed edges at one lower point: those of an edge with exactly two, in opposite
// directions.
void match_spokes(Corners& corners, Spoke* begin, Spoke* end) {
  std::sort(begin, end);
  for (Spoke* first = begin; first != end;) {
    Spoke* last = first;
    while (last != end && last->other == first->other) ++last;
    if (last - first == 2 && corners.start(first[0].corner) != corners.start(first[1].corner)) {
      corners.opposite[first[0].corner] = first[1].corner;
      corners.opposite[first[1].corner] = first[0].corner;
    }
    first = last;
  }
}

void match_opposites(Corners& corners) {
  const std::size_t points = corners.mesh.positions.size();
  const auto lower = [&](Corner c) { return std::min(corners.start(c), corners.end(c)); };
  std::vector<Corner> offsets(points + 1, 0);
  for (Corner c = 0; c < corners.count(); ++c) ++offsets[lower(c) + 1];
  for (std::size_t i = 0; i < points; ++i) offsets[i + 1] += offsets[i];
  std::vector<Spoke> spokes(corners.count());
  std::vector<Corner> cursor(offsets.begin(), offsets.end() - 1);
  for (Corner c = 0; c < corners.count(); ++c) {
    spokes[cursor[lower(c)]++] = {std::max(corners.start(c), corners.end(c)), c};
  }
  parallel_for(
      points,
      [&](std::size_t i) {
        match_spokes(corners, spokes.data() + offsets[i], spokes.data() + offsets[i + 1]);
      },
      kBlock);
}

// Assigns every corner the kernel vertex of its fan.
std::vector<std::uint32_t> split_fans(const Corners& corners, std::vector<std::uint32_t>& copies) {
  const auto points = static_cast<std::uint32_t>(corners.mesh.positions.size());
  std::vector<std::uint32_t> vertex(corners.count(), kNone);
  std::vector<char> used(points, 0);
  for (Corner seed = 0; seed < corners.count(); ++seed) {
    if (vertex[seed] != kNone) continue;
    const std::uint32_t point = corners.start(seed);
    std::uint32_t id = point;
    if (used[point] != 0) {
      id = points + static_cast<std::uint32_t>(copies.size());
      copies.push_back(point);
    }
    used[point] = 1;
    vertex[seed] = id;
    // a fan is a cycle or a path; this second sweep does nothing in a cycle
    for (Corner c = corners.opposite[previous(seed)]; c != kNone && vertex[c] == kNone;
         c = corners.opposite[previous(c)]) {
      vertex[c] = id;
    }
    for (Corner across = corners.opposite[seed]; across != kNone;) {
      const Corner c = next(across);
      if (vertex[c] != kNone) break;
      vertex[c] = id;
      across = corners.opposite[c];
    }
  }
  return vertex;
}

// Numbers the edges by their first corner; a corner's halfedge is 2e for the first, 2e + 1 for the
// second.
std::vector<std::uint32_t> number_halfedges(const Corners& corners, std::uint32_t& edges) {
  std::vector<std::uint32_t> halfedge(corners.count());
  edges = 0;
  for (Corner c = 0; c < corners.count(); ++c) {
    const Corner other = corners.opposite[c];
    halfedge[c] = other < c ? halfedge[other] + 1 : 2 * edges++;
  }
  return halfedge;
}

HalfedgeHandle handle(std::uint32_t halfedge) {
  return HalfedgeHandle(static_cast<int>(halfedge));
}

// Links the boundary halfedges. The one that ends where the edge of corner c starts is found by
// turning around that vertex within its fan.
void link_boundary(const Corners& corners, const std::vector<std::uint32_t>& halfedge,
                   OpenMesh::TriConnectivity& kernel) {
  for (Corner c = 0; c < corners.count(); ++c) {
    if (corners.opposite[c] != kNone) continue;
    Corner turn = previous(c);
    while (corners.opposite[turn] != kNone) turn = previous(corners.opposite[turn]);
    const HalfedgeHandle outside = handle(halfedge[c] ^ 1);
    kernel.set_next_halfedge_handle(outside, handle(halfedge[turn] ^ 1));
    // the outgoing halfedge of a boundary vertex is its boundary halfedge, as OpenMesh's
    // circulators expect
    kernel.set_halfedge_handle(kernel.to_vertex_handle(handle(halfedge[c])), outside);
  }
}

}  // namespace

Halfedges build_halfedges(const Mesh& mesh) {
  Corners corners{mesh, std::vector<Corner>(3 * mesh.triangles.size(), kNone)};
  match_opposites(corners);

  Halfedges result;
  const std::vector<std::uint32_t> vertex = split_fans(corners, result.copied_points_);
  std::uint32_t edges = 0;
  const std::vector<std::uint32_t> halfedge = number_halfedges(corners, edges);

  auto& kernel = result.kernel_;
  kernel.resize(mesh.positions.size() + result.copied_points_.size(), edges, mesh.triangles.size());
  parallel_for(
      mesh.triangles.size(),
      [&](std::size_t t) {
        const auto first = static_cast<Corner>(3 * t);
        const FaceHandle face(static_cast<int>(t));
        for (Corner c = first; c < first + 3; ++c) {
          const HalfedgeHandle side = handle(halfedge[c]);
          kernel.set_vertex_handle(side, VertexHandle(static_cast<int>(vertex[next(c)])));
          kernel.set_face_handle(side, face);
          kernel.set_next_halfedge_handle(side, handle(halfedge[next(c)]));
          if (corners.opposite[c] == kNone) {
            kernel.set_vertex_handle(handle(halfedge[c] ^ 1),
                                     VertexHandle(static_cast<int>(vertex[c])));
          }
        }
        kernel.set_halfedge_handle(face, handle(halfedge[first]));
      },
      kBlock);
  for (Corner c = 0; c < corners.count(); ++c) {
    kernel.set_halfedge_handle(VertexHandle(static_cast<int>(vertex[c])), handle(halfedge[c]));
  }
  link_boundary(corners, halfedge, kernel);
  return result;
}

}  // namespace triglyph
