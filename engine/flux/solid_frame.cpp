#include "engine/flux/solid_frame.h"

#include <cmath>

#include "engine/base/parallel.h"
#include "engine/geometry/symmetric_matrix.h"

namespace triglyph {
namespace {

// Of the volume in relation to the area to the power 1.5. A cube has 0.07; a plate of a hundredth
// of its length has 0.004. Below this the centre of the volume depends on noise.
constexpr double kLeastVolume = 1e-4;

// The volume of tetrahedra from an apex over triangles, with its moments about the apex.
struct SolidMoments {
  double volume = 0;  // signed
  Vec3 first;
  SymmetricMatrix second;
};

struct AreaMoments {
  double area = 0;
  Vec3 first;
};

AreaMoments area_moments(std::span<const Vec3> positions, std::span<const Triangle> triangles) {
  return parallel_reduce(
      triangles.size(), AreaMoments{},
      [&](std::size_t i) {
        const Triangle& t = triangles[i];
        const double area = triangle_area(positions, t);
        return AreaMoments{area,
                           (area / 3) * (positions[t[0]] + positions[t[1]] + positions[t[2]])};
      },
      [](AreaMoments a, const AreaMoments& b) {
        a.area += b.area;
        a.first += b.first;
        return a;
      });
}

SolidMoments solid_moments(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                           const Vec3& apex) {
  return parallel_reduce(
      triangles.size(), SolidMoments{},
      [&](std::size_t i) {
        const Triangle& t = triangles[i];
        const Vec3 a = positions[t[0]] - apex;
        const Vec3 b = positions[t[1]] - apex;
        const Vec3 c = positions[t[2]] - apex;
        const Vec3 sum = a + b + c;
        SolidMoments tetrahedron{dot(a, cross(b, c)) / 6, {}, {}};
        tetrahedron.first = (tetrahedron.volume / 4) * sum;
        for (const Vec3& v : {a, b, c, sum}) tetrahedron.second.add(v, tetrahedron.volume / 20);
        return tetrahedron;
      },
      [](SolidMoments a, const SolidMoments& b) {
        a.volume += b.volume;
        a.first += b.first;
        a.second += b.second;
        return a;
      });
}

// Turns the first two axes to where the surface's third moment is positive.
void orient(std::span<const Vec3> positions, std::span<const Triangle> triangles,
            SolidFrame& frame) {
  const Vec3 cubes = parallel_reduce(
      triangles.size(), Vec3{},
      [&](std::size_t i) {
        const Triangle& t = triangles[i];
        const Vec3 middle =
            (positions[t[0]] + positions[t[1]] + positions[t[2]]) / 3 - frame.centre;
        const double area = triangle_area(positions, t);
        Vec3 result;
        for (std::size_t axis = 0; axis < 2; ++axis) {
          result[axis] = area * std::pow(dot(middle, frame.axes[axis]), 3);
        }
        return result;
      },
      [](Vec3 a, const Vec3& b) { return a += b; });
  for (std::size_t axis = 0; axis < 2; ++axis) {
    if (cubes[axis] < 0) frame.axes[axis] = -frame.axes[axis];
  }
  frame.axes[2] = cross(frame.axes[0], frame.axes[1]);
}

}  // namespace

std::optional<SolidFrame> solid_frame(std::span<const Vec3> positions,
                                      std::span<const Triangle> triangles) {
  const AreaMoments surface = area_moments(positions, triangles);
  if (!(surface.area > 0)) return std::nullopt;
  const Vec3 apex = surface.first / surface.area;
  SolidMoments solid = solid_moments(positions, triangles, apex);
  if (!(std::abs(solid.volume) > kLeastVolume * std::pow(surface.area, 1.5))) return std::nullopt;
  const Vec3 shift = solid.first / solid.volume;
  SymmetricMatrix covariance = solid.second;
  covariance *= 1 / solid.volume;
  covariance.add(shift, -1);
  const PrincipalAxes principal = covariance.principal_axes();
  // negative where inverted parts outweigh the rest
  if (!(principal.values[2] > 0)) return std::nullopt;
  SolidFrame frame;
  frame.centre = apex + shift;
  frame.scale = kFrameScale * std::sqrt(covariance.trace());
  frame.axes = principal.axes;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    frame.spreads[axis] = std::sqrt(principal.values[axis]);
  }
  frame.orientation = solid.volume > 0 ? 1 : -1;
  orient(positions, triangles, frame);
  return frame;
}

std::vector<std::array<double, kFrameRows>> frame_rows(std::span<const Vec3> positions,
                                                       std::span<const Triangle> triangles,
                                                       const PointFaces& faces,
                                                       std::span<const Vec3> directions,
                                                       const SolidFrame& frame) {
  constexpr double kMeanSquare = 1 / (kFrameScale * kFrameScale);
  const double area = area_moments(positions, triangles).area;
  std::vector<std::array<double, kFrameRows>> rows(directions.size());
  const auto local = [&](std::uint32_t point) {
    const Vec3 x = frame.relative(positions[point]);
    return Vec3(dot(x, frame.axes[0]), dot(x, frame.axes[1]), dot(x, frame.axes[2]));
  };
  parallel_for(
      directions.size(),
      [&](std::size_t point) {
        std::array<double, kFrameRows>& row = rows[point];
        row = {};
        const Vec3 here = local(static_cast<std::uint32_t>(point));
        for (const std::uint32_t face : faces.at(static_cast<std::uint32_t>(point))) {
          const Triangle& t = triangles[face];
          // the volume that the point's hat function sweeps: quadrature at the midpoints of the
          // edges, where it is a half on two and nothing on the third
          const double swept = dot(area_normal(positions, t), directions[point]) / 12 / area;
          for (const std::uint32_t other : t) {
            if (other == point) continue;
            const Vec3 x = (here + local(other)) / 2;
            for (std::size_t axis = 0; axis < 3; ++axis) row[axis] += swept * x[axis];
            row[3] += swept * (x.sqrnorm() - kMeanSquare);
            row[4] += swept * x[0] * x[1];
            row[5] += swept * x[0] * x[2];
            row[6] += swept * x[1] * x[2];
          }
        }
      },
      kBlock);
  return rows;
}

}  // namespace triglyph
