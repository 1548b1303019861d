// One unit of IIE: the ball about a site, the cap of points that moves in it, and its invariants as
// the cap moves.
// Wang, Hu. A new watermarking method for 3D models based on integral invariants. IEEE Transactions
// on Visualization and Computer Graphics 15 (2009).
#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <optional>
#include <vector>

#include "engine/geometry/spatial_index.h"
#include "engine/mesh/surface.h"
#include "engine/scheme/iie/integral_invariants.h"

namespace triglyph {

// The surface in which balls lie, and what has been computed of it.
struct BallGround {
  const Surface& surface;
  const SpatialIndex& index;
  const std::vector<char>& at_boundary;  // one mark a triangle
  double radius;                         // of the balls, model units
  int centre_rings;                      // a centre is the mean of the points within so many rings
  std::size_t most_triangles;            // of a ball

  // Returns the mean of these points: the centre of a ball.
  [[nodiscard]] Vec3 mean_of(std::span<const std::uint32_t> points) const;
};

// Returns a bound on the number of triangles that the ball of a usable unit meets. `radius` and
// `edge`, the mean edge length, in model units.
[[nodiscard]] std::size_t most_triangles_in(double radius, double edge);

// The moves of a cap along the normal of its ball, model units.
struct CapMoves {
  double all = 0;    // of the whole cap
  double outer = 0;  // of the cap without the centre's points, on top of it
};

struct Ball {
  Vec3 centre{0, 0, 0};
  Vec3 normal{0, 0, 0};
  double radius = 0;
  std::vector<std::uint32_t> near;  // triangles that the ball meets or nearly meets
  std::vector<std::uint32_t> cap;   // points to be moved
  std::vector<double> profile;      // share of a move that each point of the cap follows
  std::vector<double> swept;        // by each of them: three times the volume, a model unit of move
  std::vector<char> is_centres;     // does the centre depend on the point?
  double centre_gain = 0;           // shift of the centre for a move of the whole cap
  double lift_all = 0;              // change of the volume share for a move of the whole cap, a
  double lift_outer = 0;            // model unit; or of all but the centre's points
  double most_inner = 0, most_outer = 0;        // of the profile, centre's points and others
  double squares_inner = 0, squares_outer = 0;  // sums of its squares

  [[nodiscard]] double move_of(std::size_t i, const CapMoves& moves) const {
    return profile[i] * (moves.all + (is_centres[i] != 0 ? 0 : moves.outer));
  }
  // Return the greatest and the root mean square of the moves of the cap's points, model units.
  [[nodiscard]] double farthest(const CapMoves& moves) const;
  [[nodiscard]] double rms(const CapMoves& moves) const;

  // Computes the lifts for the radius with which the marked mesh will be read, model units. Returns
  // false if the cap is too crumpled to change the volume.
  [[nodiscard]] bool set_lifts(double read_radius);
};

// Returns the ball about a site with the lifts of the ground's own radius; nothing where the
// surface offers no unit. O(triangles of the ball).
[[nodiscard]] std::optional<Ball> ball_at(const BallGround& ground, std::uint32_t anchor);

// A ball with a table of its invariants along the way of its centre, the cap unmoved. An entry is
// computed when it is first needed, so only one thread at a time may use a ball.
class SampledBall {
 public:
  // Returns the sampled ball at a site; nothing where there is none or where more triangles than
  // BallGround::most_triangles lie about it.
  [[nodiscard]] static std::optional<SampledBall> at(const BallGround& ground,
                                                     std::uint32_t anchor);

  [[nodiscard]] const Ball& ball() const { return ball_; }

  // Prepares the ball to be read with another radius, model units. Returns false if the cap cannot
  // change the volume then.
  [[nodiscard]] bool set_read_radius(double radius);

  // Returns the invariants after a shift of the centre along the normal, model units, interpolated
  // in the table.
  [[nodiscard]] BallInvariants interpolated(double shift);
  // Returns a small shift of the centre that brings the area to this share, by the table; nothing
  // if none does.
  [[nodiscard]] std::optional<double> shift_for_area(double area);

  // Returns the moves that bring the volume to the share `wanted` after a shift of the centre;
  // `volume` is the share at that shift with the cap unmoved.
  [[nodiscard]] CapMoves moves_to(double shift, double volume, double wanted) const;
  // Returns the exact moves for these shares, the shift being known from the table; nothing if the
  // area does not reach its share near that shift.
  [[nodiscard]] std::optional<CapMoves> refined(double shift, double area, double volume) const;

 private:
  // Between so many samples interpolation is good to about a hundredth of a cell.
  static constexpr std::size_t kSamples = 17;

  SampledBall(const Surface& surface, Ball ball)
      : surface_(&surface), ball_(std::move(ball)), read_radius_(ball_.radius) {}

  [[nodiscard]] BallInvariants exact(double shift) const;
  [[nodiscard]] double shift_of(std::size_t sample) const;
  [[nodiscard]] const BallInvariants& sample(std::size_t i);

  const Surface* surface_;
  Ball ball_;
  double read_radius_;
  std::array<BallInvariants, kSamples> samples_{};
  std::bitset<kSamples> known_;
};

}  // namespace triglyph
