// Every shape is a plan, a grid of squares some of which are missing, that is raised to a slab (or
// left as a sheet) and bent:
//
//   plan of a ball, a sheet     of a slab with k = 1
//        +-----+                   +--+--+--+
//        |     |                   |  |  |  |
//        |     |                   +--+--+--+
//        +-----+                   |  |  |  |   the square in the middle is missing
//                                  +--+--+--+
//
// Squares are cut into cells, the wall into layers; points are numbered bottom, walls, top.
#include "engine/samples/sample_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "engine/base/error.h"
#include "engine/base/parallel.h"
#include "engine/base/random.h"

namespace triglyph {
namespace {

constexpr std::uint32_t kNoPoint = 0xffffffff;
constexpr double kJitter = 0.2;  // of a cell, along each axis: below 0.25 no triangle turns over
constexpr std::size_t kRowsPerTask = 16;

// Streams of random numbers.
constexpr std::uint64_t kJitterStream = 1;
constexpr std::uint64_t kDiagonalStream = 2;
constexpr std::uint64_t kWaveStream = 3;
constexpr std::uint64_t kHoleStream = 4;

// Holes a side of the slab: grows with the seed, where the mesh is large enough to show them.
std::uint32_t holes_a_side(SampleShape shape, std::size_t triangles, std::uint64_t seed) {
  if (shape != SampleShape::HighGenus) return 0;
  auto holes = static_cast<std::uint32_t>(2 + random_bits(seed, kHoleStream, 0) % 4);
  while (holes > 1 && triangles < std::size_t{1000} * holes * holes) --holes;
  return holes;
}

// Cells along each square of the plan and layers of the wall.
struct Cuts {
  std::vector<std::uint32_t> x;
  std::vector<std::uint32_t> y;
  std::uint32_t z = 0;
};

struct Plan {
  std::uint32_t holes = 0;
  bool is_sheet = false;
  Cuts cuts;
  std::vector<std::uint32_t> square_of_x;  // of each cell
  std::vector<std::uint32_t> square_of_y;

  [[nodiscard]] std::uint32_t squares() const { return 2 * holes + 1; }
  [[nodiscard]] bool has_square(std::uint32_t i, std::uint32_t j) const {
    return i % 2 == 0 || j % 2 == 0;
  }
  [[nodiscard]] std::int64_t width() const { return static_cast<std::int64_t>(square_of_x.size()); }
  [[nodiscard]] std::int64_t depth() const { return static_cast<std::int64_t>(square_of_y.size()); }
  [[nodiscard]] bool has_cell(std::int64_t x, std::int64_t y) const {
    return x >= 0 && y >= 0 && x < width() && y < depth() &&
           has_square(square_of_x[x], square_of_y[y]);
  }
};

std::uint64_t count_triangles(const Plan& plan, const Cuts& cuts) {
  std::uint64_t cells = 0;
  std::uint64_t wall = 0;
  for (std::uint32_t i = 0; i < plan.squares(); ++i) {
    for (std::uint32_t j = 0; j < plan.squares(); ++j) {
      if (!plan.has_square(i, j)) continue;
      cells += static_cast<std::uint64_t>(cuts.x[i]) * cuts.y[j];
      if (i == 0 || !plan.has_square(i - 1, j)) wall += cuts.y[j];
      if (i + 1 == plan.squares() || !plan.has_square(i + 1, j)) wall += cuts.y[j];
      if (j == 0 || !plan.has_square(i, j - 1)) wall += cuts.x[i];
      if (j + 1 == plan.squares() || !plan.has_square(i, j + 1)) wall += cuts.x[i];
    }
  }
  return plan.is_sheet ? 2 * cells : 2 * (2 * cells + wall * cuts.z);
}

std::uint64_t count_error(const Plan& plan, const Cuts& cuts, std::uint64_t triangles) {
  const std::uint64_t count = count_triangles(plan, cuts);
  return count > triangles ? count - triangles : triangles - count;
}

// Single squares cut once more or less where that brings the count closer to the one asked for.
Cuts adjust_cuts(const Plan& plan, Cuts cuts, std::uint64_t triangles) {
  for (std::uint32_t i = 0; i < 2 * plan.squares(); ++i) {
    for (const int step : {1, -1}) {
      Cuts other = cuts;
      std::uint32_t& cut = i % 2 == 0 ? other.x[i / 2] : other.y[i / 2];
      if (step < 0 && cut == 1) continue;
      cut += step;
      if (count_error(plan, other, triangles) < count_error(plan, cuts, triangles)) cuts = other;
    }
  }
  return cuts;
}

// Cuts of about equal length along all axes.
Cuts find_cuts(const Plan& plan, std::uint64_t triangles) {
  const auto uniform = [&](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    return Cuts{std::vector<std::uint32_t>(plan.squares(), x),
                std::vector<std::uint32_t>(plan.squares(), y), z};
  };
  const auto at_one = static_cast<double>(count_triangles(plan, uniform(1, 1, 1)));
  const auto middle =
      static_cast<std::uint32_t>(std::sqrt(static_cast<double>(triangles) / at_one));
  const std::uint32_t first = middle > 2 ? middle - 1 : 1;
  Cuts best = uniform(first, first, first);
  for (std::uint32_t x = first; x <= middle + 3; ++x) {
    for (std::uint32_t y = first; y <= middle + 3; ++y) {
      for (std::uint32_t z = first; z <= (plan.is_sheet ? first : middle + 3); ++z) {
        Cuts cuts = adjust_cuts(plan, uniform(x, y, z), triangles);
        if (count_error(plan, cuts, triangles) < count_error(plan, best, triangles)) {
          best = std::move(cuts);
        }
      }
    }
  }
  return best;
}

Plan make_plan(SampleShape shape, std::size_t triangles, std::uint64_t seed) {
  Plan plan;
  plan.holes = holes_a_side(shape, triangles, seed);
  plan.is_sheet = shape == SampleShape::Open;
  plan.cuts = find_cuts(plan, triangles);
  for (std::uint32_t i = 0; i < plan.squares(); ++i) {
    plan.square_of_x.insert(plan.square_of_x.end(), plan.cuts.x[i], i);
    plan.square_of_y.insert(plan.square_of_y.end(), plan.cuts.y[i], i);
  }
  return plan;
}

// Numbers of the points over each corner of the plan's cells, row by row.
struct Numbering {
  std::int64_t columns = 0;
  std::vector<std::uint32_t> floor;  // rank among the corners of the plan; kNoPoint in a hole
  std::vector<std::uint32_t> wall;   // rank among the corners on its outline, or kNoPoint
  std::uint32_t floor_count = 0;
  std::uint32_t wall_count = 0;
  std::uint32_t layers = 0;

  [[nodiscard]] std::uint32_t point(std::int64_t x, std::int64_t y, std::uint32_t layer) const {
    const auto corner = static_cast<std::size_t>(y * columns + x);
    if (layer == 0) return floor[corner];
    if (layer == layers) return floor_count + (layers - 1) * wall_count + floor[corner];
    return floor_count + (layer - 1) * wall_count + wall[corner];
  }
  [[nodiscard]] std::size_t count() const {
    return layers == 0 ? floor_count
                       : 2 * std::size_t{floor_count} + std::size_t{layers - 1} * wall_count;
  }
};

Numbering number_points(const Plan& plan) {
  Numbering numbers;
  numbers.columns = plan.width() + 1;
  numbers.layers = plan.is_sheet ? 0 : plan.cuts.z;
  for (std::int64_t y = 0; y <= plan.depth(); ++y) {
    for (std::int64_t x = 0; x <= plan.width(); ++x) {
      const int cells = plan.has_cell(x - 1, y - 1) + plan.has_cell(x, y - 1) +
                        plan.has_cell(x - 1, y) + plan.has_cell(x, y);
      numbers.floor.push_back(cells > 0 ? numbers.floor_count++ : kNoPoint);
      numbers.wall.push_back(cells > 0 && cells < 4 ? numbers.wall_count++ : kNoPoint);
    }
  }
  return numbers;
}

// A one-to-one map of space: one wave after the other moves points along its crests, by a sine of
// the place across them. Such a shear can be undone whatever its slope, and keeps volumes.
class Bumps {
 public:
  explicit Bumps(std::uint64_t seed) {
    std::uint64_t index = 0;
    const auto draw = [&] { return random_unit(seed, kWaveStream, index++); };
    const auto draw_direction = [&] {
      const double height = 2 * draw() - 1;
      const double angle = 2 * std::numbers::pi * draw();
      const double radius = std::sqrt(1 - height * height);
      return Vec3(radius * std::cos(angle), radius * std::sin(angle), height);
    };
    double wavelength = kLongest;
    for (Wave& wave : waves_) {
      const double frequency = 2 * std::numbers::pi / wavelength;
      const Vec3 across = draw_direction();
      const Vec3 along = cross(across, draw_direction());
      wave.frequency = across * frequency;
      wave.shift = along * (kSlope / frequency / along.norm());
      wave.phase = 2 * std::numbers::pi * draw();
      wavelength *= kRatio;
    }
  }

  [[nodiscard]] Vec3 apply(const Vec3& place) const {
    Vec3 moved = place;
    for (const Wave& wave : waves_) {
      moved += wave.shift * std::sin(dot(wave.frequency, moved) + wave.phase);
    }
    return moved;
  }

 private:
  static constexpr int kWaves = 9;
  static constexpr double kLongest = 2.2;  // about the size of the shape
  static constexpr double kRatio = 0.75;   // of successive wavelengths: the last is 0.22
  static constexpr double kSlope = 0.3;    // of every wave: areas then vary by a factor of 2 or so

  struct Wave {
    Vec3 frequency;
    Vec3 shift;
    double phase = 0;
  };
  std::array<Wave, kWaves> waves_;
};

// Where the corners of the cells are before bending: squares have equal sides, cells in a square
// too.
std::vector<double> place_corners(const std::vector<std::uint32_t>& cuts) {
  std::vector<double> corners{-1.0};
  const auto squares = static_cast<double>(cuts.size());
  for (std::size_t i = 0; i < cuts.size(); ++i) {
    for (std::uint32_t k = 1; k <= cuts[i]; ++k) {
      const double along = static_cast<double>(i) + static_cast<double>(k) / cuts[i];
      corners.push_back(-1 + 2 * along / squares);
    }
  }
  return corners;
}

// From the cube [-1, 1]^3 to the ball's surface; the tangent evens out the sizes of the cells.
Vec3 project_to_ball(const Vec3& place) {
  Vec3 direction;
  for (int axis = 0; axis < 3; ++axis) {
    direction[axis] = std::tan(place[axis] * std::numbers::pi / 4);
  }
  return direction / direction.norm();
}

class PointMaker {
 public:
  PointMaker(const Plan& plan, const Numbering& numbers, std::uint64_t seed)
      : plan_(plan),
        numbers_(numbers),
        seed_(seed),
        bumps_(seed),
        x_(place_corners(plan.cuts.x)),
        y_(place_corners(plan.cuts.y)) {}

  [[nodiscard]] std::vector<Vec3> make() const {
    std::vector<Vec3> points(numbers_.count());
    const std::uint32_t top = numbers_.layers;
    parallel_for(
        static_cast<std::size_t>(plan_.depth()) + 1,
        [&](std::size_t row) {
          const auto y = static_cast<std::int64_t>(row);
          for (std::int64_t x = 0; x <= plan_.width(); ++x) {
            const auto corner = static_cast<std::size_t>(y * numbers_.columns + x);
            if (numbers_.floor[corner] == kNoPoint) continue;
            const bool is_wall = numbers_.wall[corner] != kNoPoint;
            for (std::uint32_t layer = 0; layer <= top; layer += is_wall ? 1 : std::max(1U, top)) {
              const std::uint32_t point = numbers_.point(x, y, layer);
              points[point] = place(x, y, layer, point);
            }
          }
        },
        kRowsPerTask);
    return points;
  }

 private:
  // A value in the direction of the neighbours before or after, by lot.
  [[nodiscard]] double jitter(double before, double here, double after, std::uint64_t index) const {
    const double draw = kJitter * (2 * random_unit(seed_, kJitterStream, index) - 1);
    return here + (draw < 0 ? draw * (here - before) : draw * (after - here));
  }

  // Points on a face of the slab slide in that face, points on an edge along it; corners stay.
  [[nodiscard]] Vec3 place(std::int64_t x, std::int64_t y, std::uint32_t layer,
                           std::uint64_t point) const {
    const bool left_below = plan_.has_cell(x - 1, y - 1);
    const bool right_below = plan_.has_cell(x, y - 1);
    const bool left_above = plan_.has_cell(x - 1, y);
    const bool right_above = plan_.has_cell(x, y);
    const bool slides_in_x = left_below == right_below && left_above == right_above;
    const bool slides_in_y = left_below == left_above && right_below == right_above;
    double at_x = x_[x];
    double at_y = y_[y];
    if (slides_in_x) at_x = jitter(x_[x - 1], at_x, x_[x + 1], 3 * point);
    if (slides_in_y) at_y = jitter(y_[y - 1], at_y, y_[y + 1], 3 * point + 1);
    if (plan_.is_sheet) return bumps_.apply(Vec3(at_x, at_y, 0));
    const double step = 2.0 / numbers_.layers;
    double at_z = -1 + step * layer;
    if (layer > 0 && layer < numbers_.layers) {
      at_z = jitter(at_z - step, at_z, at_z + step, 3 * point + 2);
    }
    const Vec3 raised(at_x, at_y, at_z);
    if (plan_.holes == 0) return bumps_.apply(project_to_ball(raised));
    return bumps_.apply(Vec3(at_x, at_y, at_z / plan_.squares()));
  }

  const Plan& plan_;
  const Numbering& numbers_;
  std::uint64_t seed_;
  Bumps bumps_;
  std::vector<double> x_;
  std::vector<double> y_;
};

using Quad = std::array<std::uint32_t, 4>;

// The two triangles of the index-th quad, cut along the one diagonal or the other.
void append_quad(std::uint64_t seed, std::uint64_t index, const Quad& q,
                 std::vector<Triangle>& triangles) {
  if ((random_bits(seed, kDiagonalStream, index) & 1) != 0) {
    triangles.push_back({q[0], q[1], q[2]});
    triangles.push_back({q[0], q[2], q[3]});
  } else {
    triangles.push_back({q[0], q[1], q[3]});
    triangles.push_back({q[1], q[2], q[3]});
  }
}

// The faces over one cell of the plan: floor, top and the walls to cells that are missing.
void append_cell(const Plan& plan, const Numbering& numbers, std::uint64_t seed, std::int64_t x,
                 std::int64_t y, std::vector<Triangle>& triangles) {
  if (!plan.has_cell(x, y)) return;
  // Every quad has a number of its own, used or not: the cell's place, then its side and layer.
  const std::uint64_t first =
      static_cast<std::uint64_t>(y * plan.width() + x) * (4 * std::uint64_t{numbers.layers} + 2);
  // Corners of the cell counter-clockwise seen from above, the first repeated.
  const std::int64_t xs[5] = {x, x + 1, x + 1, x, x};
  const std::int64_t ys[5] = {y, y, y + 1, y + 1, y};
  const auto corner = [&](int k, std::uint32_t layer) {
    return numbers.point(xs[k], ys[k], layer);
  };
  const std::uint32_t top = numbers.layers;
  append_quad(seed, first, {corner(0, top), corner(1, top), corner(2, top), corner(3, top)},
              triangles);
  if (plan.is_sheet) return;
  append_quad(seed, first + 1, {corner(3, 0), corner(2, 0), corner(1, 0), corner(0, 0)}, triangles);
  const bool is_wall[4] = {!plan.has_cell(x, y - 1), !plan.has_cell(x + 1, y),
                           !plan.has_cell(x, y + 1), !plan.has_cell(x - 1, y)};
  for (int side = 0; side < 4; ++side) {
    if (!is_wall[side]) continue;
    for (std::uint32_t layer = 0; layer < top; ++layer) {
      append_quad(seed, first + 2 + side * std::uint64_t{top} + layer,
                  {corner(side, layer), corner(side + 1, layer), corner(side + 1, layer + 1),
                   corner(side, layer + 1)},
                  triangles);
    }
  }
}

}  // namespace

Mesh make_sample_shape(SampleShape shape, std::size_t triangles, std::uint64_t seed) {
  check(triangles >= (shape == SampleShape::HighGenus ? 64 : 40), "a sample has some triangles");
  check(triangles <= std::size_t{1} << 32, "points are counted in 32 bits");
  const Plan plan = make_plan(shape, triangles, seed);
  const Numbering numbers = number_points(plan);
  Mesh mesh;
  mesh.positions = PointMaker(plan, numbers, seed).make();
  const auto cells = static_cast<std::size_t>(plan.width() * plan.depth());
  mesh.triangles =
      parallel_collect<Triangle>(cells, [&](std::size_t cell, std::vector<Triangle>& out) {
        const auto at = static_cast<std::int64_t>(cell);
        append_cell(plan, numbers, seed, at % plan.width(), at / plan.width(), out);
      });
  return mesh;
}

std::uint32_t genus_of_sample(SampleShape shape, std::size_t triangles, std::uint64_t seed) {
  const std::uint32_t holes = holes_a_side(shape, triangles, seed);
  return holes * holes;
}

}  // namespace triglyph
