#include "engine/scheme/iie/ring_signature.h"

#include "engine/base/parallel.h"
#include "engine/base/random.h"

namespace triglyph {
namespace {

constexpr std::size_t kPointsPerTask = 1024;

// Each point's new colour: its own and those of its ring, neighbour by neighbour. A sum over
// consecutive pairs needs no starting point and still depends on the order.
std::vector<std::uint64_t> refine(const Halfedges& halfedges,
                                  const std::vector<std::uint64_t>& colours, RingOrder order) {
  const auto pair = [order](std::uint64_t one, std::uint64_t next) {
    const std::uint64_t there = order != RingOrder::TurnedOver ? random_bits(one, 0, next) : 0;
    const std::uint64_t back = order != RingOrder::AsIs ? random_bits(next, 0, one) : 0;
    return there + back;
  };
  std::vector<std::uint64_t> refined(colours.size(), 0);
  parallel_for(
      colours.size(),
      [&](std::size_t i) {
        if (colours[i] == 0) return;
        std::uint64_t sum = 0, first = 0, last = 0;
        bool complete = true;
        visit_ring(halfedges, static_cast<std::uint32_t>(i), [&](std::uint32_t other) {
          const std::uint64_t colour = colours[other];
          complete = complete && colour != 0;
          if (first == 0) first = colour;
          if (last != 0) sum += pair(last, colour);
          last = colour;
        });
        sum += pair(last, first);
        if (complete) refined[i] = random_bits(colours[i], 1, sum) | 1;
      },
      kPointsPerTask);
  return refined;
}

}  // namespace

std::vector<std::uint64_t> ring_signatures(const Halfedges& halfedges, std::size_t points,
                                           std::uint64_t seed, RingOrder order, int rings) {
  std::vector<std::uint64_t> colours(points, 0);
  parallel_for(
      points,
      [&](std::size_t i) {
        std::uint64_t valence = 0;
        const bool closed =
            visit_ring(halfedges, static_cast<std::uint32_t>(i), [&](std::uint32_t) { ++valence; });
        if (closed) colours[i] = random_bits(seed, 2, valence) | 1;
      },
      kPointsPerTask);
  for (const std::uint32_t copied : halfedges.copied_points()) colours[copied] = 0;
  for (int ring = 0; ring < rings; ++ring) colours = refine(halfedges, colours, order);
  return colours;
}

}  // namespace triglyph
