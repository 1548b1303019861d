#include "engine/mesh/triangulate.h"

#include <algorithm>
#include <cstddef>

#include "engine/base/parallel.h"

namespace triglyph {
namespace {

bool is_before(const Vec3& a, const Vec3& b) {
  return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
}

double squared_distance(const Vec3& a, const Vec3& b) {
  return (a - b).sqrnorm();
}

void append(std::vector<Triangle>& out, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  if (a != b && b != c && c != a) out.push_back({a, b, c});
}

// Returns the start of the lexicographically least rotation of the polygon, by positions. O(n),
// also for polygons that repeat a point.
std::size_t least_rotation(std::span<const std::uint32_t> polygon, std::span<const Vec3> points) {
  const std::size_t n = polygon.size();
  std::size_t i = 0, j = 1, k = 0;
  while (i < n && j < n && k < n) {
    const std::uint32_t a = polygon[(i + k) % n], b = polygon[(j + k) % n];
    if (a == b) {
      ++k;
      continue;
    }
    // Distinct points have distinct positions.
    (is_before(points[b], points[a]) ? i : j) += k + 1;
    if (i == j) ++j;
    k = 0;
  }
  return std::min(i, j);
}

class Cutter {
 public:
  explicit Cutter(std::span<const Vec3> points) : points_(points) {}

  void cut(std::span<const std::uint32_t> polygon, std::vector<Triangle>& out) {
    switch (polygon.size()) {
      case 0:
      case 1:
      case 2:
        return;
      case 3:
        return append(out, polygon[0], polygon[1], polygon[2]);
      case 4:
        return cut_quadrangle(polygon, out);
      default:
        return cut_polygon(polygon, out);
    }
  }

 private:
  void cut_quadrangle(std::span<const std::uint32_t> q, std::vector<Triangle>& out) const {
    const auto at = [&](std::size_t i) -> const Vec3& { return points_[q[i]]; };
    const double even = squared_distance(at(0), at(2)), odd = squared_distance(at(1), at(3));
    const std::size_t first = is_before(at(2), at(0)) ? 2 : 0;   // end of each diagonal that is
    const std::size_t second = is_before(at(3), at(1)) ? 3 : 1;  // the smaller position
    std::size_t a = odd < even ? second : first;
    if (!(odd < even) && !(even < odd) && is_before(at(second), at(first))) a = second;
    append(out, q[a], q[(a + 1) % 4], q[(a + 2) % 4]);
    append(out, q[a], q[(a + 2) % 4], q[(a + 3) % 4]);
  }

  void cut_polygon(std::span<const std::uint32_t> polygon, std::vector<Triangle>& out) {
    // Sums start at a canonical corner, so their rounding does not depend on the corner the face
    // starts at.
    const std::size_t n = polygon.size(), start = least_rotation(polygon, points_);
    ring_.assign(polygon.begin(), polygon.end());
    std::rotate(ring_.begin(), ring_.begin() + static_cast<std::ptrdiff_t>(start), ring_.end());
    Vec3 mean(0, 0, 0);
    for (const std::uint32_t p : ring_) mean += points_[p] / static_cast<double>(n);
    // sum_j |p_i - p_j|^2 = n |p_i - mean|^2 + a constant
    std::size_t best = 0;
    double best_distance = squared_distance(points_[ring_[0]], mean);
    for (std::size_t i = 1; i < n; ++i) {
      const double distance = squared_distance(points_[ring_[i]], mean);
      if (best_distance < distance) continue;
      if (distance < best_distance || is_before(points_[ring_[i]], points_[ring_[best]])) {
        best = i;
        best_distance = distance;
      }
    }
    for (std::size_t i = 1; i + 1 < n; ++i) {
      append(out, ring_[best], ring_[(best + i) % n], ring_[(best + i + 1) % n]);
    }
  }

  std::span<const Vec3> points_;
  std::vector<std::uint32_t> ring_;
};

}  // namespace

std::vector<Triangle> triangulate(const Faces& faces,
                                  std::span<const std::uint32_t> point_of_vertex,
                                  std::span<const Vec3> points) {
  const std::size_t count = faces.ends.size();
  const std::size_t blocks = (count + kBlock - 1) / kBlock;
  std::vector<std::vector<Triangle>> parts(blocks);
  parallel_blocks(count, [&](std::size_t begin, std::size_t end) {
    Cutter cutter(points);
    std::vector<std::uint32_t> polygon;
    auto& part = parts[begin / kBlock];
    std::size_t corner = begin == 0 ? 0 : faces.ends[begin - 1];
    part.reserve(faces.ends[end - 1] - corner -
                 std::min<std::size_t>(faces.ends[end - 1] - corner, 2 * (end - begin)));
    for (std::size_t f = begin; f < end; ++f) {
      polygon.clear();
      for (; corner < faces.ends[f]; ++corner) {
        polygon.push_back(point_of_vertex[faces.corners[corner]]);
      }
      cutter.cut(polygon, part);
    }
  });
  std::size_t total = 0;
  for (const auto& part : parts) total += part.size();
  std::vector<Triangle> triangles;
  triangles.reserve(total);
  for (auto& part : parts) {
    triangles.insert(triangles.end(), part.begin(), part.end());
    std::vector<Triangle>().swap(part);
  }
  return triangles;
}

}  // namespace triglyph
