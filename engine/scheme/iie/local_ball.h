// One unit of IIE in its local encoding: a ball whose radius follows the edges about its site, and
// the smooth bump that changes the share of its sphere that lies inside the surface.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "engine/geometry/spatial_index.h"
#include "engine/mesh/surface.h"

namespace triglyph {

// The surface in which balls lie, and how they are measured.
struct LocalGround {
  const Surface& surface;
  const SpatialIndex& index;
  const std::vector<char>& at_boundary;  // one mark a triangle
  double radius_edges;                   // the radius in mean lengths of the edges about a site
  double radius;                         // if > 0, the radius in model units instead
  int centre_rings;                      // a centre is the mean of the points within so many rings
};

// What determines the sphere of a site: all of it is connectivity.
struct SphereFrame {
  std::vector<std::uint32_t> centre_points;               // whose mean is the centre, ascending
  std::vector<std::array<std::uint32_t, 2>> edges_about;  // whose mean length gives the radius
};

struct Sphere {
  Vec3 centre{0, 0, 0};
  double radius = 0;
  double edge = 0;  // mean length about the site
};

// Returns the frame of a site; nothing where the surface about it is open. O(edges about it).
[[nodiscard]] std::optional<SphereFrame> sphere_frame(const LocalGround& ground,
                                                      std::uint32_t anchor);

// Returns the sphere of a frame, which indexes `positions`.
[[nodiscard]] Sphere sphere_of(const SphereFrame& frame, std::span<const Vec3> positions,
                               const LocalGround& ground);

// Returns the share of a site's sphere that lies inside the surface; NaN where the surface offers
// no unit: at a boundary, where it does not cross the sphere, or where triangles lie in heaps.
// O(triangles of the ball).
[[nodiscard]] double sphere_share(const LocalGround& ground, std::uint32_t anchor);

// The bump of a site: moved by d along the normal, the points near the centre follow by all of d
// and those farther away by ever less. A copy of the surface in and about the ball, so that what a
// move does is computed as a reader will, with the centre and the radius that follow from it.
class LocalBall {
 public:
  // Returns the ball at a site; nothing where the surface offers no unit. O(triangles of the ball).
  [[nodiscard]] static std::optional<LocalBall> at(const LocalGround& ground, std::uint32_t anchor);

  // Returns the points on which the share depends, ascending.
  [[nodiscard]] std::span<const std::uint32_t> points() const { return points_; }
  // Returns the points that the bump moves, ascending.
  [[nodiscard]] std::vector<std::uint32_t> moved() const;
  // Calls visit(point, displacement) for these points, for a bump of this height, model units.
  template <typename Visit>
  void for_each_move(double height, const Visit& visit) const {
    for (std::size_t i = 0; i < points_.size(); ++i) {
      if (profile_[i] > 0) visit(points_[i], normal_ * (profile_[i] * height));
    }
  }

  // Returns the greatest height that is tried, model units.
  [[nodiscard]] double max_height() const { return max_height_; }
  // Returns the greatest and the root mean square of the moves for a bump of height 1.
  [[nodiscard]] double greatest_profile() const;
  [[nodiscard]] double rms_profile() const;

  // Returns the share after a bump of this height; NaN where the sphere is not crossed.
  [[nodiscard]] double share(double height) const;
  // Returns a small height that brings the share to this value, interpolated in a table of the
  // shares that is made when it is first needed; nothing if none does. One thread at a time.
  [[nodiscard]] std::optional<double> height_for(double share);
  // Returns the exact height, the height being known from the table; nothing if there is none
  // near it.
  [[nodiscard]] std::optional<double> refined(double height, double share) const;

 private:
  // Shares are nearly linear in the height: between so many samples interpolation is good to a
  // hundredth of a cell.
  static constexpr std::size_t kSamples = 9;

  [[nodiscard]] double height_of(std::size_t sample) const;

  const LocalGround* ground_ = nullptr;
  SphereFrame frame_;                  // of local indices
  std::vector<std::uint32_t> points_;  // the mesh's, ascending
  std::vector<Vec3> positions_;        // local
  std::vector<Triangle> triangles_;    // local
  std::vector<std::uint32_t> all_;     // 0 .. triangles - 1
  std::vector<double> profile_;        // of each point
  Vec3 normal_{0, 0, 0};
  double max_height_ = 0;
  std::array<double, kSamples> samples_{};
  bool is_sampled_ = false;
};

}  // namespace triglyph
