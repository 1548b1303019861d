// TSQ, the similarity-invariant scheme: a unit is a triangle M with its three edge neighbours, six
// points in all.
//
//        D2 ------ v2 ------ D1        v0 -> v1 is the longest edge of M, in M's winding;
//          \      /  \      /          S lies across it, D1 and D2 across the next two.
//           \    / M  \    /
//            v0 ------ v1              M carries the marker, S the subscript, D1 and D2 the part:
//              \      /                two numbers of each triangle's shape, quantised.
//               \ S  /
//                                      M moves in its own plane, then the three outer corners in
//                                      the planes of their triangles.
//
// This work is based on:
// Ohbuchi, Masuda, Aono. Watermarking three-dimensional polygonal models. ACM Multimedia 1997.
// Wang, Hu. Optimization approach for 3D model watermarking by linear binary programming. CAGD
// 2010.
//
// Survives similarity transforms, any reordering, cropping and rounding well below a cell; not
// general affine maps, noise of the size of a cell, remeshing, or flipping the mesh's winding.
#pragma once

#include <array>

#include "engine/scheme/quantiser.h"
#include "engine/scheme/scheme.h"
#include "engine/scheme/tsq/triangle_shape.h"
#include "engine/scheme/tsq/tsq_options.h"

namespace triglyph {

class TsqScheme final : public Scheme {
 public:
  // Throws Error Usage if the step is out of range.
  TsqScheme(const WordCode& code, const TsqOptions& options);

  // Binds the scheme; O(1). Anchors are triangles. All calls are parallel: find_units and read take
  // O(triangles), read_at O(anchors), costs O(chosen * words), embed O(placements). The cost of
  // the marker is part of every entry.
  [[nodiscard]] std::unique_ptr<BoundScheme> bind(const Surface& surface) const override;

 private:
  // The quantisers of the two numbers of a triangle's shape.
  struct Channel {
    Quantiser height;
    Quantiser log_ratio;

    [[nodiscard]] int bits() const { return height.bits() + log_ratio.bits(); }
    [[nodiscard]] std::uint32_t height_bits(std::uint32_t bits) const {
      return bits & ((1U << height.bits()) - 1);
    }
    [[nodiscard]] std::uint32_t ratio_bits(std::uint32_t bits) const {
      return bits >> height.bits();
    }
  };
  // M with the marker embedded: its moved corners, and the outer triangles on their moved bases.
  struct Marked {
    std::array<Vec3, 3> corners;
    std::array<FlatTriangle, 3> outer;  // S, D1, D2
  };
  struct Apex {
    double x = 0;       // of the base
    double height = 0;  // of the base
    double move = 0;    // model units
  };

  class Bound;
  class ApexChoices;
  class ApexMoves;

  // Returns where the apex of outer triangle i must go to carry these bits.
  [[nodiscard]] std::optional<Vec3> place_apex(const Mesh& mesh,
                                               std::span<const std::uint32_t> points,
                                               const Marked& marked, std::size_t i,
                                               std::uint32_t bits) const;

  [[nodiscard]] static Channel make_channel(const WordCode& code, double step, int bits,
                                            std::size_t role);
  [[nodiscard]] std::optional<FlatCorners> reshape_to_marker(const FlatTriangle& triangle) const;
  [[nodiscard]] std::optional<Marked> embed_marker(const Mesh& mesh,
                                                   std::span<const std::uint32_t> points) const;
  [[nodiscard]] std::array<std::uint32_t, 3> outer_bits(const Word& word) const;
  [[nodiscard]] bool has_marker(const FlatTriangle& triangle, Reading& reading) const;
  void read_outer(const Mesh& mesh, const std::array<std::uint32_t, 6>& points,
                  Reading& reading) const;

  TsqOptions options_;
  std::uint32_t marker_;
  Channel marker_channel_;
  std::array<Channel, 3> outer_channels_;  // S, D1, D2
};

}  // namespace triglyph
