#include "engine/attack/collusion.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/error.h"
#include "engine/base/parallel.h"
#include "engine/base/random.h"
#include "engine/base/text.h"

namespace triglyph {
namespace {

constexpr auto kCollusions = std::to_array<CollusionKind>({
    {Collusion::Average, "average", "the mean of the points", false},
    {Collusion::Majority, "majority",
     "the median of each coordinate; of an even number, the mean of the two middle ones", false},
    {Collusion::Minimum, "minimum", "the least of each coordinate", false},
    {Collusion::Maximum, "maximum", "the greatest of each coordinate", false},
    {Collusion::Extremes, "extremes", "the least or the greatest of each coordinate, by lot", true},
    {Collusion::Pick, "pick", "each point from a copy drawn by lot", true},
    {Collusion::Mix, "mix", "the surface in regions, twelve from each copy, dealt by lot", true},
});

// Enough that every part of a mesh has regions of several copies, and each is large enough to hold
// units of its copy.
constexpr std::size_t kRegionsOfACopy = 12;

// What an attack that follows draws with the same seed shall not be the same lots.
constexpr std::uint64_t kStreamOfCollusion = 0x636f6c6c756465;

[[noreturn]] void refuse_copies(const std::string& reason) {
  throw Error(ErrorCode::Usage, {}, "", reason);
}

void check_copies(std::span<const Mesh> copies) {
  if (copies.size() < 2) {
    refuse_copies("a collusion takes two copies or more, not " + std::to_string(copies.size()));
  }
  const Mesh& first = copies.front();
  for (std::size_t i = 1; i < copies.size(); ++i) {
    const std::string name = "copy " + std::to_string(i + 1);
    const Mesh& copy = copies[i];
    if (copy.positions.size() != first.positions.size()) {
      refuse_copies(name + " has " + std::to_string(copy.positions.size()) + " points, the first " +
                    std::to_string(first.positions.size()));
    }
    if (copy.triangles.size() != first.triangles.size()) {
      refuse_copies(name + " has " + std::to_string(copy.triangles.size()) +
                    " triangles, the first " + std::to_string(first.triangles.size()));
    }
    const auto [own, other] =
        std::mismatch(copy.triangles.begin(), copy.triangles.end(), first.triangles.begin());
    if (own == copy.triangles.end()) continue;
    refuse_copies(name + " differs from the first at triangle " +
                  std::to_string(own - copy.triangles.begin() + 1));
  }
}

// From the least value on, so that equal values give themselves and any order the same.
double mean_of(std::span<const double> ascending) {
  const double least = ascending.front();
  double above = 0;
  for (const double value : ascending) above += value - least;
  return std::min(least + above / static_cast<double>(ascending.size()), ascending.back());
}

double median_of(std::span<const double> ascending) {
  const std::size_t upper = ascending.size() / 2;
  if (ascending.size() % 2 == 1) return ascending[upper];
  return std::midpoint(ascending[upper - 1], ascending[upper]);
}

// Combines the values of one coordinate; `lot` is a random number of 64 bits.
double combined(Collusion collusion, std::span<const double> ascending, std::uint64_t lot) {
  switch (collusion) {
    case Collusion::Average:
      return mean_of(ascending);
    case Collusion::Majority:
      return median_of(ascending);
    case Collusion::Minimum:
      return ascending.front();
    case Collusion::Maximum:
      return ascending.back();
    default:
      return lot % 2 == 0 ? ascending.front() : ascending.back();
  }
}

std::vector<Vec3> combined_points(std::span<const Mesh> copies, Collusion collusion,
                                  std::uint64_t seed) {
  std::vector<Vec3> points(copies.front().positions.size());
  parallel_blocks(points.size(), [&](std::size_t begin, std::size_t end) {
    std::vector<double> values(copies.size());
    for (std::size_t i = begin; i < end; ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        for (std::size_t c = 0; c < copies.size(); ++c) values[c] = copies[c].positions[i][axis];
        std::sort(values.begin(), values.end());
        points[i][axis] = combined(collusion, values, random_bits(seed, axis, i));
      }
    }
  });
  return points;
}

std::vector<Vec3> picked_points(std::span<const Mesh> copies, std::uint64_t seed) {
  std::vector<Vec3> points(copies.front().positions.size());
  parallel_blocks(points.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      points[i] = copies[random_bits(seed, 0, i) % copies.size()].positions[i];
    }
  });
  return points;
}

// Some of the points, in an order drawn by lot.
std::vector<Vec3> drawn_points(std::span<const Vec3> points, std::size_t count,
                               std::uint64_t seed) {
  std::vector<std::pair<std::uint64_t, std::size_t>> lots(points.size());
  for (std::size_t i = 0; i < lots.size(); ++i) lots[i] = {random_bits(seed, 0, i), i};
  const std::size_t drawn = std::min(count, lots.size());
  std::partial_sort(lots.begin(), lots.begin() + static_cast<std::ptrdiff_t>(drawn), lots.end());
  std::vector<Vec3> result;
  for (std::size_t r = 0; r < drawn; ++r) result.push_back(points[lots[r].second]);
  return result;
}

std::vector<Vec3> mixed_points(std::span<const Mesh> copies, std::uint64_t seed) {
  const std::vector<Vec3>& first = copies.front().positions;
  const std::vector<Vec3> seeds = drawn_points(first, kRegionsOfACopy * copies.size(), seed);
  std::vector<Vec3> points(first.size());
  parallel_blocks(points.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto nearest =
          std::min_element(seeds.begin(), seeds.end(), [&](const Vec3& a, const Vec3& b) {
            return (a - first[i]).sqrnorm() < (b - first[i]).sqrnorm();
          });
      const auto region = static_cast<std::size_t>(nearest - seeds.begin());
      points[i] = copies[region % copies.size()].positions[i];
    }
  });
  return points;
}

}  // namespace

std::span<const CollusionKind> collusion_kinds() {
  return kCollusions;
}

const CollusionKind& collusion_named(std::string_view name) {
  std::vector<std::string> names;
  for (const CollusionKind& kind : kCollusions) {
    if (kind.name == name) return kind;
    names.emplace_back(kind.name);
  }
  std::string reason = "there is no collusion named \"" + std::string(name) + "\"";
  if (const auto closest = closest_word(name, names)) {
    refuse_copies(reason + "; did you mean " + *closest + "?");
  }
  for (std::size_t i = 0; i < names.size(); ++i)
    reason += (i == 0 ? "; it is one of " : ", ") + names[i];
  refuse_copies(reason);
}

Mesh colluded(std::span<const Mesh> copies, Collusion collusion, std::uint64_t seed) {
  check_copies(copies);
  const std::uint64_t own = random_bits(seed, kStreamOfCollusion, 0);
  const std::vector<Triangle>& triangles = copies.front().triangles;
  switch (collusion) {
    case Collusion::Pick:
      return {picked_points(copies, own), triangles};
    case Collusion::Mix:
      return {mixed_points(copies, own), triangles};
    default:
      return {combined_points(copies, collusion, own), triangles};
  }
}

}  // namespace triglyph
