#include "engine/mesh/weld.h"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <utility>

#include "engine/base/parallel.h"

namespace triglyph {
namespace {

constexpr std::uint32_t kEmptySlot = std::numeric_limits<std::uint32_t>::max();
// Vertices below which one table fits the cache, and threads would cost more than they save.
constexpr std::size_t kSmall = 1 << 16;
constexpr std::size_t kParts = 256;      // of the hash space; enough to balance the threads
constexpr std::size_t kSlice = 1 << 16;  // vertices that one task counts and scatters

std::uint64_t bits_of(double coordinate) {
  return std::bit_cast<std::uint64_t>(coordinate + 0.0);  // -0 + 0 = 0
}

std::uint64_t hash_of(const Vec3& v) {
  // Two multiplications and a rotation spread the high bits, where short decimals differ.
  std::uint64_t h = bits_of(v[0]) * 0x9e3779b97f4a7c15ULL;
  h = (std::rotl(h, 29) ^ bits_of(v[1])) * 0xbf58476d1ce4e5b9ULL;
  h = (std::rotl(h, 31) ^ bits_of(v[2])) * 0x94d049bb133111ebULL;
  return h ^ (h >> 32);
}

bool are_equal(const Vec3& a, const Vec3& b) {
  return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

// A hash table of vertex indices with open addressing; it keeps the first of equal vertices.
class FirstTable {
 public:
  FirstTable(std::span<const Vec3> vertices, std::size_t entries)
      : vertices_(vertices),
        slots_(std::bit_ceil(std::max<std::size_t>(2 * entries, 16)), kEmptySlot) {}

  // Returns the first vertex added with the coordinates of vertex i, which may be i itself.
  std::uint32_t add(std::uint32_t i, std::uint64_t hash) {
    const std::size_t mask = slots_.size() - 1;
    for (std::size_t slot = hash & mask;; slot = (slot + 1) & mask) {
      if (slots_[slot] == kEmptySlot) return slots_[slot] = i;
      if (are_equal(vertices_[slots_[slot]], vertices_[i])) return slots_[slot];
    }
  }

 private:
  std::span<const Vec3> vertices_;
  std::vector<std::uint32_t> slots_;
};

std::size_t part_of(std::uint64_t hash) {
  return hash >> 56;
}

// Returns, for every vertex, the first vertex with equal coordinates. A stable partition keeps the
// vertices of a part in file order, so the result does not depend on the thread that welds the
// part.
std::vector<std::uint32_t> find_first(std::span<const Vec3> vertices) {
  const std::size_t n = vertices.size();
  const std::size_t slices = (n + kSlice - 1) / kSlice;
  std::vector<std::uint64_t> hashes(n);
  std::vector<std::array<std::uint32_t, kParts>> begins(slices);
  parallel_for(slices, [&](std::size_t s) {
    begins[s].fill(0);
    for (std::size_t i = s * kSlice; i < std::min(n, (s + 1) * kSlice); ++i) {
      hashes[i] = hash_of(vertices[i]);
      ++begins[s][part_of(hashes[i])];
    }
  });
  std::array<std::uint32_t, kParts + 1> bounds{};
  std::uint32_t total = 0;
  for (std::size_t part = 0; part < kParts; ++part) {
    bounds[part] = total;
    for (auto& begin : begins) total += std::exchange(begin[part], total);
  }
  bounds[kParts] = total;
  std::vector<std::uint32_t> order(n);
  parallel_for(slices, [&](std::size_t s) {
    for (std::size_t i = s * kSlice; i < std::min(n, (s + 1) * kSlice); ++i) {
      order[begins[s][part_of(hashes[i])]++] = static_cast<std::uint32_t>(i);
    }
  });
  std::vector<std::uint32_t> first(n);
  parallel_for(kParts, [&](std::size_t part) {
    FirstTable table(vertices, bounds[part + 1] - bounds[part]);
    for (std::uint32_t k = bounds[part]; k < bounds[part + 1]; ++k) {
      first[order[k]] = table.add(order[k], hashes[order[k]]);
    }
  });
  return first;
}

std::vector<std::uint32_t> find_first_serially(std::span<const Vec3> vertices) {
  std::vector<std::uint32_t> first(vertices.size());
  FirstTable table(vertices, vertices.size());
  for (std::uint32_t i = 0; i < first.size(); ++i) first[i] = table.add(i, hash_of(vertices[i]));
  return first;
}

}  // namespace

Weld weld(std::span<const Vec3> vertices) {
  const std::size_t n = vertices.size();
  Weld result;
  result.point_of_vertex = n < kSmall ? find_first_serially(vertices) : find_first(vertices);
  auto& point_of = result.point_of_vertex;
  // first[i] <= i, so the first vertex is numbered before vertex i.
  for (std::size_t i = 0; i < n; ++i) {
    if (point_of[i] == i) {
      point_of[i] = static_cast<std::uint32_t>(result.points.size());
      const Vec3& v = vertices[i];
      result.points.emplace_back(v[0] + 0.0, v[1] + 0.0, v[2] + 0.0);
    } else {
      point_of[i] = point_of[point_of[i]];
    }
  }
  return result;
}

}  // namespace triglyph
