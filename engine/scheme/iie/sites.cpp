#include "engine/scheme/iie/sites.h"

#include "engine/base/parallel.h"

namespace triglyph {
namespace {

std::vector<char> triangles_at_boundary(const Halfedges& halfedges) {
  std::vector<char> at_boundary(halfedges.face_count(), 0);
  parallel_for(
      at_boundary.size(),
      [&](std::size_t t) {
        Halfedge side = halfedges.first_of_face(static_cast<std::uint32_t>(t));
        for (int i = 0; i < 3; ++i) {
          if (halfedges.is_boundary(halfedges.opposite(side))) at_boundary[t] = 1;
          side = halfedges.next(side);
        }
      },
      kBlock);
  return at_boundary;
}

}  // namespace

IieSites find_sites(const Halfedges& halfedges, std::size_t points, int rings, std::uint64_t seed,
                    RingOrder order) {
  const std::vector<std::uint64_t> signatures = ring_signatures(halfedges, points, seed, order);
  const auto is_site = [&](std::uint32_t point) {
    const std::uint64_t own = signatures[point];
    if (own == 0) return false;
    if (rings == 0) return true;
    // nearly all points fail already against their neighbours
    bool beats_ring = true;
    visit_ring(halfedges, point,
               [&](std::uint32_t other) { beats_ring = beats_ring && signatures[other] <= own; });
    return beats_ring && accepted_points_within(halfedges, point, rings, [&](std::uint32_t other) {
                           return signatures[other] <= own;
                         }).has_value();
  };
  IieSites sites;
  sites.points =
      parallel_collect<std::uint32_t>(points, [&](std::size_t i, std::vector<std::uint32_t>& out) {
        const auto point = static_cast<std::uint32_t>(i);
        if (is_site(point)) out.push_back(point);
      });
  sites.at_boundary = triangles_at_boundary(halfedges);
  return sites;
}

}  // namespace triglyph
