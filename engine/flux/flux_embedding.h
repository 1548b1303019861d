// Writing a flux mark: the smoothest displacement of the surface that brings every functional to a
// value that carries its bit and leaves the frame where it is. Which of the values that carry a bit
// is approached is chosen for the whole mark at once, so that the sum of change is least: the
// second step of Wang & Hu, CAGD 27 (2010), for a functional in place of a unit.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "engine/flux/block_code.h"
#include "engine/flux/closed_mesh.h"
#include "engine/flux/lattice.h"
#include "engine/flux/thin_plate.h"

namespace triglyph {

// What the shape of a mesh allows.
enum class FluxObstacle : std::uint8_t {
  None,
  NoVolume,    // the mesh encloses next to nothing: a flat sheet
  NoAxes,      // two principal axes are equal, as in a ball or a cube: octants have no place
  TooNarrow,   // the surface lies in too few shells and octants
  TooFaint,    // no mark that moves the surface little enough would be found
  TooVisible,  // likewise, within limits that the user set
};

struct FluxLimits {
  double rms_percent = 0.07;  // the root mean square of the moves, of the surface's diagonal
};

// The evidence, in bits, that a mark leaves, before anything is paid for what a reader tries: the
// least after noise and after quantisation.
struct FluxExpectation {
  double after_usual_noise = 0;   // 0.3 % of the mean distance to the centre, 9 bits
  double after_little_noise = 0;  // 0.1 %, 11 bits
};

// What a reader must know of a surface to read a mark from a part of it: the frame, which a part
// does not have, and the functionals without the mark.
struct FluxSolid {
  SolidFrame frame;
  FluxValues values;

  // Returns that of a surface; nothing if it has no frame. O(triangles), parallel.
  [[nodiscard]] static std::optional<FluxSolid> of(const Surface& surface);
};

// A mesh prepared for marks of any payload and key: functionals, their derivatives, and the
// displacements that change one functional alone.
class FluxCanvas {
 public:
  // The surface must outlive the canvas. O(triangles) plus a factorisation, see ThinPlate.
  explicit FluxCanvas(const Surface& surface);
  // A canvas to read from and not to write to: `surface` is a coarse one, whose points lie on the
  // surface that the solid was taken of. With some thousand points it tells as much of a part as
  // the whole surface does, since a mark is smooth.
  FluxCanvas(const Surface& surface, const FluxSolid& solid);
  ~FluxCanvas();
  FluxCanvas(const FluxCanvas&) = delete;
  FluxCanvas& operator=(const FluxCanvas&) = delete;

  [[nodiscard]] FluxObstacle obstacle() const { return obstacle_; }
  // Returns the number of functionals that a mark uses.
  [[nodiscard]] std::size_t used() const { return used_.size(); }

  struct Written {
    std::vector<Vec3> positions;
    std::size_t step = 0;    // index, see step_size()
    double rms_percent = 0;  // of the surface's diagonal
    double residual = 0;     // root mean square distance of the functionals from their goals, steps
  };
  // Returns the positions of all points with the phases embedded at the largest step within the
  // limits; nothing if there is none. May be called from several threads at a time.
  [[nodiscard]] std::optional<Written> write(const FluxPhases& phases, const Dither& dither,
                                             const FluxLimits& limits) const;

  // Returns the functionals that a mark brought about, of a surface of which only a part is left:
  // `places[i]` is where point i is now, nothing where it is gone. The mark is the smoothest
  // displacement that changes the functionals as it does, so that what is left of it tells of the
  // whole. `doubts` are standard deviations, normalised as the values; infinite for functionals
  // that are not used. May be called from several threads at a time. Precondition: no obstacle.
  struct Estimate {
    Measurement measurement;
    FluxVector doubts{};
  };
  [[nodiscard]] Estimate estimated(std::span<const std::optional<Vec3>> places) const;

  // Returns what a mark of this step is expected to prove.
  [[nodiscard]] FluxExpectation expected_evidence(std::size_t step) const;
  // Returns the largest step within the limits on average over keys; nothing if there is none.
  [[nodiscard]] std::optional<std::size_t> expected_step(const FluxLimits& limits) const;

 private:
  struct Basis;

  // Prepares the displacements of single functionals, unless there is an obstacle.
  void prepare(const std::vector<Vec3>& positions);
  // Returns the displacements for points that follow them so far, 0 to 1.
  [[nodiscard]] std::shared_ptr<const Basis> make_basis(std::span<const double> weights) const;
  // Returns the changes under noise of some amplitude and under quantisation to so many bits.
  [[nodiscard]] std::vector<std::vector<double>> noise_of(double amplitude, int bits) const;
  // Makes the neighbourhoods of faces that turned too far follow less, or keeps corners of faces
  // that are turned over in place; false if there are none.
  [[nodiscard]] bool follow_less(std::span<const Vec3> positions, bool only_flipped,
                                 std::vector<double>& weights) const;
  [[nodiscard]] std::vector<double> changes(const Basis& basis, const FluxPhases& phases,
                                            const Dither& dither, double step) const;
  [[nodiscard]] std::vector<Vec3> moved(std::span<const double> unknowns,
                                        std::span<const double> weights) const;
  // Returns the used functionals of the surface with other positions; nothing without a frame.
  [[nodiscard]] std::vector<double> used_values(std::span<const Vec3> positions) const;
  [[nodiscard]] double squared_move(std::span<const Vec3> positions) const;

  const Surface surface_;
  ClosedMesh closed_;
  FluxObstacle obstacle_ = FluxObstacle::None;
  double diagonal_ = 0;  // of the surface, model units
  SolidFrame frame_;
  Measurement before_{};
  std::vector<std::uint32_t> used_;  // functionals, ascending
  std::vector<Vec3> directions_;     // unit normals of the points
  std::optional<ThinPlate> plate_;
  FluxDerivatives derivatives_;
  std::vector<std::array<double, kFrameRows>> frame_rows_;
  std::shared_ptr<const Basis> basis_;
  // changes of the used functionals under noise and quantisation, usual and little
  std::vector<std::vector<double>> usual_noise_;
  std::vector<std::vector<double>> little_noise_;
};

}  // namespace triglyph
