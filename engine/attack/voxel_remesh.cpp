#include "engine/attack/voxel_remesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <tuple>
#include <vector>

#include "engine/base/error.h"
#include "engine/base/parallel.h"
#include "engine/geometry/box.h"

namespace triglyph {
namespace {

using Cell = std::array<std::uint32_t, 3>;

// Corners of voxels. They are shifted against the box by shares of a voxel that no model shares, so
// that hardly a ray meets a point or an edge of the mesh.
class Grid {
 public:
  Grid(const Box& box, int voxels) : width_(box.size().max() / voxels) {
    constexpr Vec3 kShift(0.4142135, 0.7320508, 0.2360679);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low_[axis] = box.low[axis] - (1 + kShift[axis]) * width_;
      counts_[axis] = static_cast<std::uint32_t>(std::ceil(box.size()[axis] / width_)) + 4;
    }
  }
  [[nodiscard]] double width() const { return width_; }
  [[nodiscard]] std::uint32_t count(std::size_t axis) const { return counts_[axis]; }
  [[nodiscard]] double at(std::size_t axis, std::uint32_t i) const {
    return low_[axis] + i * width_;
  }
  // Returns a coordinate in voxels from the first corner.
  [[nodiscard]] double place(std::size_t axis, double x) const { return (x - low_[axis]) / width_; }
  [[nodiscard]] std::size_t index(const Cell& c) const {
    return (std::size_t{c[2]} * counts_[1] + c[1]) * counts_[0] + c[0];
  }
  [[nodiscard]] std::size_t size() const {
    return std::size_t{counts_[0]} * counts_[1] * counts_[2];
  }

 private:
  double width_;  // model units
  Vec3 low_;
  std::array<std::uint32_t, 3> counts_{};
};

// Where the ray through corners of the grid meets the mesh.
struct Crossing {
  std::uint32_t ray = 0;  // v * count(u) + u, over the two other axes
  double depth = 0;       // voxels along the ray's axis
  int turn = 0;           // 1 or -1, by the side from which the triangle is met

  bool operator<(const Crossing& other) const {
    return std::tie(ray, depth, turn) < std::tie(other.ray, other.depth, other.turn);
  }
};

// The rays along one axis, and what they meet, sorted.
struct Rays {
  std::size_t axis = 0;
  std::size_t u = 1;
  std::size_t v = 2;
  std::vector<Crossing> crossings;

  [[nodiscard]] std::uint32_t ray(const Grid& grid, const Cell& c) const {
    return c[v] * grid.count(u) + c[u];
  }
};

// Twice the signed area of p, q and the point (x, y). The order of p and q changes nothing but the
// sign, to the last bit, so that a ray through the common edge of two triangles meets one of them.
double side_of(std::array<double, 2> p, std::array<double, 2> q, double x, double y) {
  const bool swapped = q < p;
  if (swapped) std::swap(p, q);
  const double area = (q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0]);
  return swapped ? -area : area;
}

void cross_triangle(const Grid& grid, const Rays& rays, const std::array<Vec3, 3>& corners,
                    std::vector<Crossing>& out) {
  std::array<std::array<double, 2>, 3> flat{};
  for (std::size_t i = 0; i < 3; ++i) flat[i] = {corners[i][rays.u], corners[i][rays.v]};
  std::array<std::uint32_t, 2> low{};
  std::array<std::uint32_t, 2> high{};
  for (std::size_t i = 0; i < 2; ++i) {
    const auto [least, most] = std::minmax({flat[0][i], flat[1][i], flat[2][i]});
    low[i] = static_cast<std::uint32_t>(std::ceil(least));
    high[i] = static_cast<std::uint32_t>(std::floor(most));
  }
  for (std::uint32_t y = low[1]; y <= high[1]; ++y) {
    for (std::uint32_t x = low[0]; x <= high[0]; ++x) {
      std::array<double, 3> share{};  // of the corner opposite to the side
      for (std::size_t i = 0; i < 3; ++i) {
        share[(i + 2) % 3] = side_of(flat[i], flat[(i + 1) % 3], x, y);
      }
      const bool left = share[0] > 0 && share[1] > 0 && share[2] > 0;
      const bool right = share[0] < 0 && share[1] < 0 && share[2] < 0;
      if (!left && !right) continue;
      double depth = 0;
      for (std::size_t i = 0; i < 3; ++i) depth += share[i] * corners[i][rays.axis];
      out.push_back(
          {y * grid.count(rays.u) + x, depth / (share[0] + share[1] + share[2]), left ? 1 : -1});
    }
  }
}

Rays cast_rays(const Mesh& mesh, const Grid& grid, std::size_t axis) {
  Rays rays{axis, (axis + 1) % 3, (axis + 2) % 3, {}};
  rays.crossings = parallel_collect<Crossing>(mesh.triangles.size(), [&](std::size_t t, auto& out) {
    std::array<Vec3, 3> corners;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3& p = mesh.positions[mesh.triangles[t][i]];
      for (std::size_t k = 0; k < 3; ++k) corners[i][k] = grid.place(k, p[k]);
    }
    cross_triangle(grid, rays, corners, out);
  });
  parallel_sort(rays.crossings.begin(), rays.crossings.end(), std::less<>());
  return rays;
}

// What the three directions find of a corner: how many call it inside, and 16 times how many know.
using Vote = std::uint8_t;
constexpr Vote kOutside = 0x10;
constexpr Vote kInside = 0x11;

// Lets the rays along one axis vote on the corners that they pass. A ray that meets nothing votes
// for outside.
void vote(const Grid& grid, const Rays& rays, std::vector<Vote>& votes) {
  std::size_t next = 0;
  const auto& met = rays.crossings;
  Cell c{};
  for (c[rays.v] = 0; c[rays.v] < grid.count(rays.v); ++c[rays.v]) {
    for (c[rays.u] = 0; c[rays.u] < grid.count(rays.u); ++c[rays.u]) {
      const std::uint32_t ray = rays.ray(grid, c);
      const std::size_t begin = next;
      int winding = 0;
      for (; next < met.size() && met[next].ray == ray; ++next) winding += met[next].turn;
      if (winding != 0) continue;  // through a hole
      std::size_t at = begin;
      for (c[rays.axis] = 0; c[rays.axis] < grid.count(rays.axis); ++c[rays.axis]) {
        for (; at < next && met[at].depth < c[rays.axis]; ++at) winding += met[at].turn;
        Vote& corner = votes[grid.index(c)];
        corner = static_cast<Vote>(corner + (winding != 0 ? kInside : kOutside));
      }
    }
  }
}

// The solid as corners inside and outside, and the places where its border cuts the grid.
class Solid {
 public:
  Solid(const Mesh& mesh, const Grid& grid) : grid_(grid), inside_(grid.size(), 0) {
    std::vector<Vote> votes(grid.size(), 0);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      rays_[axis] = cast_rays(mesh, grid, axis);
      vote(grid, rays_[axis], votes);
    }
    for (std::size_t i = 0; i < votes.size(); ++i) {
      inside_[i] = 2 * (votes[i] & 0xfU) > (votes[i] >> 4U) ? 1 : 0;
    }
  }
  [[nodiscard]] bool holds(const Cell& c) const { return inside_[grid_.index(c)] != 0; }

  // Returns where the border cuts the edge from a corner to the next along an axis, in voxels from
  // the corner; the middle if the rays along other axes overruled those along this one.
  [[nodiscard]] double cut(const Cell& from, std::size_t axis) const {
    const Rays& rays = rays_[axis];
    const std::uint32_t ray = rays.ray(grid_, from);
    auto at = std::lower_bound(rays.crossings.begin(), rays.crossings.end(),
                               Crossing{ray, double(from[axis]), -2});
    double sum = 0;
    double count = 0;
    for (; at != rays.crossings.end() && at->ray == ray && at->depth < from[axis] + 1; ++at) {
      sum += at->depth - from[axis];
      count += 1;
    }
    return count > 0 ? sum / count : 0.5;
  }

 private:
  const Grid& grid_;
  std::array<Rays, 3> rays_;
  std::vector<char> inside_;
};

Cell stepped(Cell c, std::size_t axis) {
  ++c[axis];
  return c;
}

// Returns the point of the voxel with this lowest corner, or nothing if the border does not pass
// it.
std::optional<Vec3> point_in(const Grid& grid, const Solid& solid, const Cell& low) {
  Vec3 sum(0, 0, 0);
  double cuts = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t u = (axis + 1) % 3;
    const std::size_t v = (axis + 2) % 3;
    for (std::uint32_t i = 0; i < 4; ++i) {
      Cell from = low;
      from[u] += i & 1U;
      from[v] += i >> 1U;
      if (solid.holds(from) == solid.holds(stepped(from, axis))) continue;
      Vec3 place(from[0], from[1], from[2]);
      place[axis] += solid.cut(from, axis);
      sum += place;
      cuts += 1;
    }
  }
  if (cuts == 0) return std::nullopt;
  const Vec3 mean = sum / cuts;
  return Vec3(grid.at(0, 0), grid.at(1, 0), grid.at(2, 0)) + grid.width() * mean;
}

// Two triangles for the four points about an edge of the grid, cut along the shorter diagonal.
void add_square(Mesh& mesh, const std::array<std::uint32_t, 4>& p) {
  const double first = (mesh.positions[p[0]] - mesh.positions[p[2]]).sqrnorm();
  const double second = (mesh.positions[p[1]] - mesh.positions[p[3]]).sqrnorm();
  if (first <= second) {
    mesh.triangles.push_back({p[0], p[1], p[2]});
    mesh.triangles.push_back({p[0], p[2], p[3]});
  } else {
    mesh.triangles.push_back({p[1], p[2], p[3]});
    mesh.triangles.push_back({p[1], p[3], p[0]});
  }
}

// The voxels that the border passes, ascending by the index of their lowest corner.
struct BorderCells {
  std::vector<Cell> cells;
  std::vector<std::size_t> indices;

  [[nodiscard]] std::uint32_t number(std::size_t index) const {
    const auto at = std::lower_bound(indices.begin(), indices.end(), index);
    return static_cast<std::uint32_t>(at - indices.begin());
  }
};

BorderCells add_points(const Grid& grid, const Solid& solid, Mesh& mesh) {
  BorderCells border;
  Cell c{};
  for (c[2] = 0; c[2] + 1 < grid.count(2); ++c[2]) {
    for (c[1] = 0; c[1] + 1 < grid.count(1); ++c[1]) {
      for (c[0] = 0; c[0] + 1 < grid.count(0); ++c[0]) {
        const std::optional<Vec3> point = point_in(grid, solid, c);
        if (!point) continue;
        mesh.positions.push_back(*point);
        border.cells.push_back(c);
        border.indices.push_back(grid.index(c));
      }
    }
  }
  return border;
}

void add_faces(const Grid& grid, const Solid& solid, const BorderCells& border, Mesh& mesh) {
  for (const Cell& c : border.cells) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t u = (axis + 1) % 3;
      const std::size_t v = (axis + 2) % 3;
      // the outermost corners lie outside the box, so an edge there is never cut
      const bool inside = solid.holds(c);
      if (inside == solid.holds(stepped(c, axis))) continue;
      std::array<std::uint32_t, 4> around{};
      for (std::uint32_t i = 0; i < 4; ++i) {
        Cell cell = c;
        cell[u] -= i == 0 || i == 3 ? 1 : 0;
        cell[v] -= i == 0 || i == 1 ? 1 : 0;
        around[i] = border.number(grid.index(cell));
      }
      // counter-clockwise seen from the end of the axis, where outside is if the corner is inside
      if (!inside) std::swap(around[1], around[3]);
      add_square(mesh, around);
    }
  }
}

}  // namespace

Mesh remeshed_by_voxels(const Mesh& mesh, int voxels) {
  check(voxels >= 2 && voxels <= 512, "voxels along a side: 2 to 512");
  Mesh result;
  const Box box = bounding_box(mesh.positions);
  if (mesh.triangles.empty() || !(box.size().max() > 0)) return result;
  const Grid grid(box, voxels);
  const Solid solid(mesh, grid);
  const BorderCells border = add_points(grid, solid, result);
  add_faces(grid, solid, border, result);
  return result;
}

}  // namespace triglyph
