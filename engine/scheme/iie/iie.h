// IIE, the noise-robust scheme: a unit is a ball about a place on the surface. The share of its
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

#include "engine/scheme/iie/iie_options.h"
#include "engine/scheme/iie/integral_invariants.h"
#include "engine/scheme/quantiser.h"
#include "engine/scheme/scheme.h"

namespace triglyph {

class LocalCost;

class IieScheme final : public Scheme {
 public:
  // Throws Error Usage if marker and subscript, or the part, have more than 16 bits, or for a step,
  // radius or number of rings out of range.
  IieScheme(const WordCode& code, const IieOptions& options);

  // Anchors are points. O(points * triangles a ball), parallel.
  [[nodiscard]] UnitSet find_units(const Surface& surface) const override;

  // From a table of the invariants along each centre's way: good to about a hundredth of a cell.
  // O(chosen * (triangles a ball + words)), parallel over units.
  [[nodiscard]] CostMatrix costs(const Surface& surface, const UnitSet& units,
                                 std::span<const std::uint32_t> chosen,
                                 std::span<const Word> words) const override;

  [[nodiscard]] Embedding embed(const Surface& surface, const UnitSet& units,
                                std::span<const Placement> placements,
                                std::span<const Word> words) const override;

  // Of several readings within one ball only the best centred stays: two units never lie so close.
  [[nodiscard]] std::vector<Reading> read(const Surface& surface) const override;

  [[nodiscard]] PointLists points_of(const Surface& surface,
                                     std::span<const std::uint32_t> anchors) const override;

 private:
  struct Ground;  // a surface with all that is worked out once for it
  struct Ball;    // one unit, ready to be moved
  struct Moves {
    double all = 0;    // of the whole cap along n, model units
    double outer = 0;  // of the cap without the centre's points
  };
  struct Plan {
    double area = 0;  // shares to be reached
    double volume = 0;
    double shift = 0;  // of the centre along n, model units
    Moves moves;
  };

  [[nodiscard]] Embedding embed_on(const Ground& ground, const UnitSet& units,
                                   std::span<const Placement> placements,
                                   std::span<const Word> words) const;
  [[nodiscard]] std::optional<Ball> ball_at(const Ground& ground, std::uint32_t anchor) const;
  [[nodiscard]] static std::vector<std::uint32_t> cap_of(const Ground& ground, std::uint32_t anchor,
                                                         const Vec3& centre);
  static void weigh_cap(const Ground& ground, std::span<const std::uint32_t> centre_points,
                        Ball& ball);
  [[nodiscard]] std::optional<double> centre_shift(const Ball& ball, double area) const;
  [[nodiscard]] static Moves moves_to(const Ball& ball, double shift, double volume, double wanted);
  [[nodiscard]] std::optional<Plan> plan(const Ball& ball, const Word& word) const;
  [[nodiscard]] float cost_of(const Mesh& mesh, const LocalCost& local, const Ball& ball,
                              const Moves& moves) const;
  [[nodiscard]] static std::optional<Moves> refine(const Ground& ground, const Ball& ball,
                                                   const Plan& plan);
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
