// AIE, the affine-invariant scheme: a unit is an interior edge. The four points of its two
// triangles are an affine basis and stay where they are; their neighbours, in four groups, carry a
// quarter of the word each, in the logarithm of their affine-invariant norm relative to the basis.
//
// This work is based on:
// Benedens, Busch. Towards blind detection of robust watermarks in polygonal models. Eurographics
// 2000.
// Wang, Hu. Optimization approach for 3D model watermarking by linear binary programming. CAGD
// 2010.
// 1. The logarithm of the norm is quantised: on scans the norm itself spans three orders of
//    magnitude, and its cells would be too wide for some and too narrow for others.
// 2. A point moves to the nearest point of the norm's level set instead of along the ray from the
//    basis' mean, which in flat places is many times as far.
// 3. Where basis and neighbours lie in a plane (CAD parts) the norm is that of the plane, with
//    cells kPlaneSteps times narrower.
// 4. The bits of marker, subscript and part are dealt out to the groups in turn. A group that
//    carried nothing but the marker would have to move as far in whatever unit and under whatever
//    word, and assignment could not better it.
//
// Survives affine maps, also with reflection, any reordering, cropping and rounding well below a
// cell; not noise (the norm amplifies it wherever the surface is flat), remeshing, or flipping the
// mesh's winding.
#pragma once

#include <array>

#include "engine/scheme/aie/affine_norm.h"
#include "engine/scheme/aie/aie_options.h"
#include "engine/scheme/aie/edge_neighbourhood.h"
#include "engine/scheme/quantiser.h"
#include "engine/scheme/scheme.h"

namespace triglyph {

class LocalCost;

class AieScheme final : public Scheme {
 public:
  // Throws Error Usage if m + s + w > 32 or the step is out of range.
  AieScheme(const WordCode& code, const AieOptions& options);

  // Binds the scheme; O(1). An anchor is kAlternatives * edge + grouping. All calls are parallel:
  // find_units and read take O(edges), read_at O(anchors), costs O(chosen * (2^(bits of a group) +
  // words)), embed O(placements). Every edge is read in both directions and with every grouping; of
  // nested groupings that read the same word one counts.
  [[nodiscard]] std::unique_ptr<BoundScheme> bind(const Surface& surface) const override;

  static constexpr std::uint32_t kAlternatives = 2;

 private:
  // Within a plane the norm does not amplify rounding, so that cells may be narrower; the period of
  // 64 cells, which bounds the moves, shrinks with them.
  static constexpr double kPlaneSteps = 16;

  // The quantisers of one group.
  struct Channel {
    Quantiser solid;
    Quantiser plane;

    [[nodiscard]] const Quantiser& quantiser(const AffineNorm& norm) const {
      return norm.is_plane() ? plane : solid;
    }
    [[nodiscard]] int bits() const { return solid.bits(); }
  };
  using GroupBits = std::array<std::uint32_t, 4>;  // the bits of a word that each group carries
  class Bound;
  struct Basis;  // the norm of an edge that may be marked
  struct Site;   // a unit's norm and groups
  struct Way;    // the readings of the groups in one direction of the edge

  // The reading that a group's points vote for.
  struct GroupReading {
    std::uint32_t bits = 0;
    float distance = 1;  // from the cells' centres, in half cells
    bool unanimous = false;
  };
  struct UnitReading {
    Reading reading;
    bool unanimous = true;  // in every group
  };

  [[nodiscard]] static Channel make_channel(const WordCode& code, double step, std::size_t group);
  [[nodiscard]] GroupRule rule_of(std::uint32_t anchor) const;
  [[nodiscard]] GroupBits deal_out(const Word& word) const;
  [[nodiscard]] static std::optional<Basis> basis_at(const Surface& surface, std::uint32_t edge);
  [[nodiscard]] std::optional<EdgeNeighbourhood> neighbours_of(const Surface& surface,
                                                               const Basis& basis,
                                                               std::uint32_t anchor) const;
  [[nodiscard]] std::optional<Site> site_at(const Surface& surface, std::uint32_t anchor) const;
  [[nodiscard]] std::optional<Vec3> place(const Site& site, std::size_t group, const Vec3& point,
                                          std::uint32_t bits) const;
  [[nodiscard]] float group_cost(const Mesh& mesh, const LocalCost& local, const Site& site,
                                 std::size_t group, std::uint32_t bits) const;
  [[nodiscard]] static GroupReading read_group(const Quantiser& quantiser,
                                               std::span<const double> values);
  [[nodiscard]] bool shows_marker(std::size_t group, std::uint32_t bits) const;
  [[nodiscard]] UnitReading unit_of(const Way& way, std::uint32_t anchor) const;
  [[nodiscard]] std::optional<UnitReading> read_unit(const Surface& surface, const AffineNorm& norm,
                                                     std::uint32_t anchor, EdgeWay way) const;

  AieOptions options_;
  WordFormat format_;
  std::uint32_t marker_;
  std::array<Channel, 4> channels_;
};

}  // namespace triglyph
