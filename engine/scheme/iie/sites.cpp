#include "engine/scheme/iie/sites.h"

#include <algorithm>

#include "engine/base/parallel.h"

namespace triglyph {
namespace {

// Rings of a signature that tells places apart also where most points have six neighbours.
constexpr int kScatteredRings = 4;
// A few points of one signature are the two sides of a symmetric shape, or copies of a part.
constexpr std::size_t kMostAlike = 8;

struct Signed {
  std::uint64_t signature;
  std::uint32_t point;
};

// The points that have a signature that few share, by descending signature.
std::vector<Signed> ranked_points(const std::vector<std::uint64_t>& signatures) {
  std::vector<Signed> all;
  for (std::uint32_t i = 0; i < signatures.size(); ++i) {
    if (signatures[i] != 0) all.push_back({signatures[i], i});
  }
  parallel_sort(all.begin(), all.end(), [](const Signed& a, const Signed& b) {
    return a.signature != b.signature ? a.signature > b.signature : a.point < b.point;
  });
  std::vector<Signed> ranked;
  for (std::size_t begin = 0, end = 0; begin < all.size(); begin = end) {
    while (end < all.size() && all[end].signature == all[begin].signature) ++end;
    if (end - begin > kMostAlike) continue;
    ranked.insert(ranked.end(), all.begin() + static_cast<std::ptrdiff_t>(begin),
                  all.begin() + static_cast<std::ptrdiff_t>(end));
  }
  return ranked;
}

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
  for (const std::uint32_t point : sites.points) sites.signatures.push_back(signatures[point]);
  sites.at_boundary = triangles_at_boundary(halfedges);
  return sites;
}

IieSites scatter_sites(const Halfedges& halfedges, std::size_t points, int rings,
                       std::uint64_t seed) {
  const std::vector<Signed> ranked =
      ranked_points(ring_signatures(halfedges, points, seed, RingOrder::Either, kScatteredRings));
  std::vector<Signed> chosen;
  std::vector<char> is_taken(points, 0);
  // the site whose rings were walked last through each point
  std::vector<std::uint32_t> seen_from(points, 0xffffffff);
  std::vector<std::uint32_t> last, next;
  for (const Signed& candidate : ranked) {
    if (is_taken[candidate.point] != 0) continue;
    chosen.push_back(candidate);
    is_taken[candidate.point] = 1;
    seen_from[candidate.point] = candidate.point;
    last.assign(1, candidate.point);
    for (int ring = 0; ring < rings; ++ring) {
      next.clear();
      for (const std::uint32_t from : last) {
        visit_ring(halfedges, from, [&](std::uint32_t other) {
          if (seen_from[other] == candidate.point) return;
          seen_from[other] = candidate.point;
          is_taken[other] = 1;
          next.push_back(other);
        });
      }
      std::swap(last, next);
    }
  }
  std::sort(chosen.begin(), chosen.end(),
            [](const Signed& a, const Signed& b) { return a.point < b.point; });
  IieSites sites;
  for (const Signed& site : chosen) {
    sites.points.push_back(site.point);
    sites.signatures.push_back(site.signature);
  }
  sites.at_boundary = triangles_at_boundary(halfedges);
  return sites;
}

UnitSet units_at(const IieSites& sites, std::span<const SiteUnit> found) {
  UnitSet units;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (found[i].moved.empty()) continue;
    units.anchors.push_back(sites.points[i]);
    units.moved.append(std::span<const std::uint32_t>(found[i].moved));
    units.read.append(std::span<const std::uint32_t>(found[i].read));
  }
  return units;
}

}  // namespace triglyph
