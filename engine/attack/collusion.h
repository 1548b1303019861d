// Collusion: the holders of several copies of one mesh, each marked for another of them, make one
// mesh of them all, in which no copy's mark shall be left. Copies are combined as they lie: nothing
// is turned, scaled or shifted to fit.
//
// This work is based on:
// Wu, Trappe, Wang, Liu. Collusion-resistant fingerprinting for multimedia. IEEE Signal Processing
// Magazine 21(2) (2004), whose linear collusions are averaging and cutting and pasting, and whose
// others take the order of the values: least, greatest, median, one of the extremes at random.
//
// 1. Where the paper draws between least and greatest, the shares of the two are the attacker's to
//    choose; Extremes draws evenly, which needs no knowledge of the marks.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "engine/mesh/mesh.h"

namespace triglyph {

enum class Collusion { Average, Majority, Minimum, Maximum, Extremes, Pick, Mix };

struct CollusionKind {
  Collusion collusion;
  std::string_view name;
  std::string_view help;    // what it takes of the copies, a noun phrase
  bool draws_lots = false;  // depends on the seed
};

// Returns all kinds, in the order of help and documentation.
[[nodiscard]] std::span<const CollusionKind> collusion_kinds();

// Returns the kind of that name. Throws Error Usage that says which one may be meant.
[[nodiscard]] const CollusionKind& collusion_named(std::string_view name);

// Returns one mesh of the copies, with their triangles, a function of copies, kind and seed alone,
// for any number of threads. Point i is made of the points i of the copies, in model units:
// - Average: of their means. The copies' order makes no difference, and equal copies give
//   themselves, to the last bit.
// - Majority: coordinate by coordinate of the median, which is the value that more than half of the
//   copies share, if there is one; of an even number of copies, of the mean of the two middle ones.
// - Minimum, Maximum: coordinate by coordinate of the least and of the greatest.
// - Extremes: coordinate by coordinate of one of these two, drawn by lot.
// - Pick: of a copy drawn by lot for the point.
// - Mix: of the copy of its region. Points drawn by lot from the first copy, twelve a copy, or all
//   if there are fewer, are seeds; a point belongs to the nearest of them in space. The seeds are
//   dealt to the copies in turn, so that every copy is used if there are as many points as copies.
// Points may lie at equal coordinates: see stored(). Throws Error Usage for fewer than two copies,
// and for a copy whose number of points or whose triangles are not those of the first; it names
// them by their numbers, from 1. O(points * copies * log copies), Mix O(points * copies), parallel.
[[nodiscard]] Mesh colluded(std::span<const Mesh> copies, Collusion collusion, std::uint64_t seed);

}  // namespace triglyph
