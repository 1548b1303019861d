// The local encoding of IIE, which messages use: the share of a ball's sphere that lies inside the
// surface carries marker and part, and the site fixes the subscript.
//
// Differs from iie.h, the encoding of generation 1 and of fill, in that
// 1. The radius of a ball follows the edges about its site, so that nothing done elsewhere to the
//    mesh, cropping or units that are put back, changes it.
// 2. The signature of a site gives the subscript, so that nothing has to move to show it. Words are
//    parities of the whole message (spread.h): any will do, and no unit need carry a given one.
// 3. It whitens the cells as well. On a flat face all balls show the same share, and sites without
//    a mark would agree on a value.
// 4. There is one invariant and so one bump, which falls off smoothly, and few bits a unit, so that
//    it is low.
// 5. Sites are so far apart that nearly all of them are units.
// 6. The signature of a site is that of its mirror image.
#pragma once

#include <cstdint>
#include <memory>

#include "engine/scheme/iie/iie_options.h"
#include "engine/scheme/iie/local_ball.h"
#include "engine/scheme/quantiser.h"
#include "engine/scheme/scheme.h"

namespace triglyph {

class LocalCost;

class LocalIieScheme final : public Scheme {
 public:
  // Throws Error Usage if marker and part have more than 16 bits, or for a step, radius
  // or number of rings out of range.
  LocalIieScheme(const WordCode& code, const IieOptions& options);

  // Binds the scheme: builds a spatial index, O(t log t) for t triangles, and finds the sites.
  // Anchors are points. All calls are parallel: find_units and read take O(sites * triangles a
  // ball), read_at O(anchors * the same), costs O(chosen * (triangles a ball + words)). Costs come
  // from a table of the shares over the bump's height and are good to about a hundredth of a cell.
  [[nodiscard]] std::unique_ptr<BoundScheme> bind(const Surface& surface) const override;

 private:
  class Bound;
  struct Plan {
    double share = 0;   // to be reached
    double height = 0;  // of the bump, model units
  };

  // What its signature makes of a site: the only subscript it may carry, and the bits with which
  // its cells are whitened.
  struct SiteKey {
    std::uint32_t subscript = 0;
    std::uint32_t mask = 0;
  };

  [[nodiscard]] SiteKey key_of(std::uint64_t signature) const;
  // Returns the bits of the cells for a word of the site's subscript.
  [[nodiscard]] std::uint32_t bits_of(const Word& word, const SiteKey& key) const {
    return (marker_ | word.part << format_.marker_bits) ^ key.mask;
  }
  [[nodiscard]] float bit_weight(double share, const Quantiser::Cell& cell, int bit) const;
  [[nodiscard]] std::optional<Plan> plan(LocalBall& ball, std::uint32_t bits) const;
  [[nodiscard]] float cost_of(const Mesh& mesh, const LocalCost& local, const LocalBall& ball,
                              double height) const;

  IieOptions options_;
  WordFormat format_;
  std::uint32_t marker_;
  Quantiser quantiser_;
  std::uint64_t site_seed_;
};

}  // namespace triglyph
