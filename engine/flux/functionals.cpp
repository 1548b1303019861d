#include "engine/flux/functionals.h"

#include <algorithm>
#include <cmath>

#include "engine/base/parallel.h"

namespace triglyph {
namespace {

// Half the width of the soft step between two octants, as a direction cosine.
constexpr double kSoftStep = 0.3;

// Triangles are cut until their edges are shorter than this, in units of the scale: the profile of
// a shell is a polynomial of degree four over twice this length.
constexpr double kPieceEdge = kShellWidth / 2;

// No triangle is cut into more pieces than the square of this. Needles across a whole mesh are
// integrated a little less exactly then.
constexpr int kMostCuts = 64;

// Corner weights of the three points of a quadrature rule that is exact for quadratic polynomials.
constexpr std::array<Vec3, 3> kRule = {Vec3(2.0 / 3, 1.0 / 6, 1.0 / 6),
                                       Vec3(1.0 / 6, 2.0 / 3, 1.0 / 6),
                                       Vec3(1.0 / 6, 1.0 / 6, 2.0 / 3)};

// A triangle in the frame's units, turned outwards.
struct LocalTriangle {
  std::array<Vec3, 3> corners;
  Vec3 normal;  // unit; zero of degenerate triangles
  double area = 0;
  int cuts = 1;

  LocalTriangle(std::span<const Vec3> positions, const Triangle& triangle,
                const SolidFrame& frame) {
    double longest = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3 x = frame.relative(positions[triangle[c]]);
      for (std::size_t axis = 0; axis < 3; ++axis) corners[c][axis] = dot(x, frame.axes[axis]);
    }
    for (std::size_t c = 0; c < 3; ++c) {
      longest = std::max(longest, (corners[c] - corners[(c + 1) % 3]).norm());
    }
    const Vec3 twice = frame.orientation * area_normal(corners[0], corners[1], corners[2]);
    area = twice.norm() / 2;
    if (area > 0) normal = twice / (2 * area);
    cuts = static_cast<int>(std::clamp(std::ceil(longest / kPieceEdge), 1.0, double{kMostCuts}));
  }

  // Calls visit(corner weights, point, area) for every point of the quadrature.
  template <typename Visit>
  void for_each_point(const Visit& visit) const {
    const double piece_area = area / (cuts * cuts) / 3;
    const auto piece = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
      for (const Vec3& rule : kRule) {
        const Vec3 weights = rule[0] * a + rule[1] * b + rule[2] * c;
        visit(weights, weights[0] * corners[0] + weights[1] * corners[1] + weights[2] * corners[2],
              piece_area);
      }
    };
    const auto grid = [&](int i, int j) { return Vec3(i, j, cuts - i - j) / cuts; };
    for (int i = 0; i < cuts; ++i) {
      for (int j = 0; j < cuts - i; ++j) {
        piece(grid(i, j), grid(i + 1, j), grid(i, j + 1));
        if (i + j < cuts - 1) piece(grid(i + 1, j + 1), grid(i, j + 1), grid(i + 1, j));
      }
    }
  }
};

// The share of every octant at a direction; they add up to 1.
std::array<double, kOctants> octant_shares(const Vec3& direction) {
  std::array<double, kOctants> shares;
  shares.fill(1);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double x = std::clamp(direction[axis] / kSoftStep, -1.0, 1.0);
    const double positive = (1 + std::sin(M_PI / 2 * x)) / 2;
    for (std::size_t octant = 0; octant < kOctants; ++octant) {
      shares[octant] *= (octant >> axis & 1U) == 0 ? positive : 1 - positive;
    }
  }
  return shares;
}

// Calls visit(shell, t) for the shells at a distance from the centre; t is the offset from the
// shell's middle in half widths, within -1 and 1.
template <typename Visit>
void for_each_shell(double distance, const Visit& visit) {
  const double place = distance / kShellWidth - 0.5;
  const double below = std::floor(place);
  for (const double shell : {below, below + 1}) {
    if (shell < 0 || shell >= static_cast<double>(kShells)) continue;
    visit(static_cast<std::size_t>(shell), place - shell);
  }
}

// The profile of a shell, (1 - t^2)^2: smooth to the first derivative at its ends.
double profile(double t) {
  return (1 - t * t) * (1 - t * t);
}

// The divergence of the radial field of a shell, times its half width.
double divergence(double t, double distance) {
  return -4 * t * (1 - t * t) + 2 * kShellWidth * profile(t) / std::max(distance, 1e-9);
}

}  // namespace

FluxValues flux_values(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                       const SolidFrame& frame) {
  std::vector<FluxValues> parts((triangles.size() + kBlock - 1) / kBlock);
  parallel_blocks(triangles.size(), [&](std::size_t begin, std::size_t end) {
    FluxValues& part = parts[begin / kBlock];
    for (std::size_t i = begin; i < end; ++i) {
      const LocalTriangle triangle(positions, triangles[i], frame);
      if (!(triangle.area > 0)) continue;
      triangle.for_each_point([&](const Vec3&, const Vec3& x, double area) {
        const double distance = x.norm();
        if (!(distance > 0)) return;
        const Vec3 direction = x / distance;
        const std::array<double, kOctants> shares = octant_shares(direction);
        const double outwards = dot(direction, triangle.normal);
        for_each_shell(distance, [&](std::size_t shell, double t) {
          const double weight = area * profile(t);
          for (std::size_t octant = 0; octant < kOctants; ++octant) {
            const std::size_t at = shell * kOctants + octant;
            part.weight[at] += weight * shares[octant];
            part.flux[at] += kShellWidth * weight * shares[octant] * outwards;
          }
        });
      });
    }
  });
  FluxValues total;
  for (const FluxValues& part : parts) {
    for (std::size_t i = 0; i < kFunctionals; ++i) {
      total.flux[i] += part.flux[i];
      total.weight[i] += part.weight[i];
    }
  }
  return total;
}

FluxDerivatives flux_derivatives(std::span<const Vec3> positions,
                                 std::span<const Triangle> triangles, const PointFaces& faces,
                                 std::span<const Vec3> directions, const SolidFrame& frame) {
  const std::size_t points = directions.size();
  std::vector<std::vector<FluxDerivatives::Entry>> parts((points + kBlock - 1) / kBlock);
  FluxDerivatives result;
  result.offsets.assign(points + 1, 0);
  parallel_blocks(points, [&](std::size_t begin, std::size_t end) {
    std::vector<FluxDerivatives::Entry>& entries = parts[begin / kBlock];
    for (std::size_t point = begin; point < end; ++point) {
      FluxVector row{};
      for (const std::uint32_t face : faces.at(static_cast<std::uint32_t>(point))) {
        const Triangle& corners = triangles[face];
        const LocalTriangle triangle(positions, corners, frame);
        if (!(triangle.area > 0)) continue;
        const auto corner = static_cast<std::size_t>(
            std::find(corners.begin(), corners.end(), point) - corners.begin());
        Vec3 move;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          move[axis] = dot(directions[point], frame.axes[axis]) / frame.scale;
        }
        const double swept = dot(move, triangle.normal);
        triangle.for_each_point([&](const Vec3& weights, const Vec3& x, double area) {
          const double distance = x.norm();
          if (!(distance > 0)) return;
          const std::array<double, kOctants> shares = octant_shares(x / distance);
          for_each_shell(distance, [&](std::size_t shell, double t) {
            const double change = area * weights[corner] * swept * divergence(t, distance);
            for (std::size_t octant = 0; octant < kOctants; ++octant) {
              row[shell * kOctants + octant] += change * shares[octant];
            }
          });
        });
      }
      for (std::uint32_t i = 0; i < kFunctionals; ++i) {
        if (row[i] != 0) entries.push_back({i, static_cast<float>(row[i])});
      }
      result.offsets[point + 1] = entries.size();
    }
  });
  // offsets so far count within a block
  std::size_t before = 0;
  for (std::size_t block = 0; block < parts.size(); ++block) {
    const std::size_t end = std::min(points, (block + 1) * kBlock);
    for (std::size_t point = block * kBlock; point < end; ++point) {
      result.offsets[point + 1] += before;
    }
    before += parts[block].size();
  }
  result.entries.reserve(before);
  for (auto& part : parts) {
    result.entries.insert(result.entries.end(), part.begin(), part.end());
    std::vector<FluxDerivatives::Entry>().swap(part);
  }
  return result;
}

}  // namespace triglyph
