// IIE, the noise-robust scheme, in its global encoding: that of fill and of the first generation of
// marks; messages use local_iie.h. A unit is a ball about a place on the surface. The share of its
// sphere that lies inside the surface carries marker and subscript, the share of its volume the
// part.
//
//          .-' .  centre  . '-.         The centre is the mean of the anchor and its one-ring.
//        .'   _____.-*-._____  '.       The cap of points that no triangle crossing the sphere
//       / .--'  <-- cap -->  '--.\      uses moves along one direction n: first all of it, which
//      |-'                       '-|    moves the centre and so changes the area; then all but
//       \         inside         /      the points of the centre, which changes the volume and
//        '.                    .'       no longer the area.
//          '-.____________.-'
//
// This work is based on:
// Wang, Hu. A new watermarking method for 3D models based on integral invariants. IEEE Transactions
// on Visualization and Computer Graphics 15 (2009).
// Yang, Lai, Hu, Pottmann. Robust principal curvatures on multiple scales. SGP 2006.
// 1. Area is embedded by moving the centre instead of the shell around the sphere: a unit then
//    moves nothing near its sphere, and two fit where they would have disturbed each other.
// 2. The centre is a mean, so that the noise of single points averages out.
// 3. For messages, only points whose keyed ring signature beats all near ones are centres. Noise
//    does not change it, and nearly all look-alikes are never read.
//
// Survives any reordering, rigid motion and scale (with the relative radius), rounding,
// quantisation and noise well below a cell. Semi-fragile: what is cut, remeshed or reshaped loses
// its units, which shows where. Not general affine maps, smoothing of the shape, or cropping that
// changes the mean edge length.
#pragma once

#include <optional>

#include "engine/scheme/iie/ball.h"
#include "engine/scheme/iie/iie_options.h"
#include "engine/scheme/quantiser.h"
#include "engine/scheme/scheme.h"

namespace triglyph {

class LocalCost;

class IieScheme final : public Scheme {
 public:
  // Throws Error Usage if marker and subscript, or the part, have more than 16 bits, or for a step,
  // radius or number of rings out of range.
  IieScheme(const WordCode& code, const IieOptions& options);

  // Binds the scheme: builds a spatial index, O(t log t) for t triangles, and finds the sites.
  // Anchors are points. All calls are parallel: find_units, read and read_at take O(sites *
  // triangles a ball), costs O(chosen * (triangles a ball + words)). Costs come from a table of the
  // invariants along the way of each centre and are good to about a hundredth of a cell; the balls
  // of the chosen units are kept for embed, some 2 kB each. Of several readings within one radius
  // only the best centred stays: two units never lie so close.
  [[nodiscard]] std::unique_ptr<BoundScheme> bind(const Surface& surface) const override;

 private:
  class Bound;
  struct Plan {
    double area = 0;  // shares to be reached
    double volume = 0;
    double shift = 0;  // of the centre along n, model units
    CapMoves moves;
  };

  [[nodiscard]] std::optional<Plan> plan(SampledBall& sampled, const Word& word) const;
  [[nodiscard]] float cost_of(const Mesh& mesh, const LocalCost& local, const Ball& ball,
                              const CapMoves& moves) const;
  [[nodiscard]] std::uint32_t area_bits(const Word& word) const {
    return marker_ | word.subscript << marker_bits_;
  }

  IieOptions options_;
  std::uint32_t marker_;
  int marker_bits_;
  Quantiser area_;
  Quantiser volume_;
  std::uint64_t site_seed_;
};

}  // namespace triglyph
