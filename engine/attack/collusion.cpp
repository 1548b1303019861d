#include "engine/attack/collusion.h"

#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <vector>

#include "engine/base/error.h"
#include "engine/base/random.h"
#include "engine/base/text.h"

namespace triglyph {
namespace {

// Streams of random numbers.
constexpr std::uint64_t kPick = 0x7069636b, kSeeds = 0x6d6978, kOwners = 0x6d697832;

// Pieces of a mixed mesh for each copy.
constexpr std::size_t kPiecesPerCopy = 6;

// Combines the coordinates of each point, axis by axis.
template <typename Combine>
Mesh by_coordinate(std::span<const Mesh> copies, const Combine& combine) {
  Mesh result = copies[0];
  std::vector<double> values(copies.size());
  for (std::size_t i = 0; i < result.positions.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::size_t k = 0; k < copies.size(); ++k) values[k] = copies[k].positions[i][axis];
      result.positions[i][axis] = combine(values);
    }
  }
  return result;
}

Mesh averaged(std::span<const Mesh> copies, std::uint64_t /*seed*/) {
  return by_coordinate(copies, [](const std::vector<double>& values) {
    double sum = 0;
    for (const double value : values) sum += value;
    return sum / static_cast<double>(values.size());
  });
}

Mesh of_majority(std::span<const Mesh> copies, std::uint64_t /*seed*/) {
  return by_coordinate(copies, [](std::vector<double>& values) {
    std::sort(values.begin(), values.end());
    const std::size_t middle = values.size() / 2;
    return values.size() % 2 == 1 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
  });
}

Mesh of_minimum(std::span<const Mesh> copies, std::uint64_t /*seed*/) {
  return by_coordinate(copies, [](const std::vector<double>& values) {
    return *std::min_element(values.begin(), values.end());
  });
}

Mesh of_maximum(std::span<const Mesh> copies, std::uint64_t /*seed*/) {
  return by_coordinate(copies, [](const std::vector<double>& values) {
    return *std::max_element(values.begin(), values.end());
  });
}

Mesh picked(std::span<const Mesh> copies, std::uint64_t seed) {
  Mesh result = copies[0];
  for (std::size_t i = 0; i < result.positions.size(); ++i) {
    result.positions[i] = copies[random_bits(seed, kPick, i) % copies.size()].positions[i];
  }
  return result;
}

// Every point belongs to the nearest of some points drawn by lot, and these to the copies in turn.
Mesh mixed(std::span<const Mesh> copies, std::uint64_t seed) {
  Mesh result = copies[0];
  const std::vector<Vec3>& positions = copies[0].positions;
  if (positions.empty()) return result;
  std::vector<Vec3> centres;
  for (std::size_t i = 0; i < kPiecesPerCopy * copies.size(); ++i) {
    centres.push_back(positions[random_bits(seed, kSeeds, i) % positions.size()]);
  }
  const std::size_t first = random_bits(seed, kOwners, 0) % copies.size();
  for (std::size_t i = 0; i < positions.size(); ++i) {
    std::size_t nearest = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t c = 0; c < centres.size(); ++c) {
      const double distance = (positions[i] - centres[c]).sqrnorm();
      if (distance >= least) continue;
      least = distance;
      nearest = c;
    }
    result.positions[i] = copies[(first + nearest) % copies.size()].positions[i];
  }
  return result;
}

constexpr std::array<CollusionKind, 6> kCollusions = {{
    {"average", "the mean of the points", averaged},
    {"majority", "the median of each coordinate, or the mean of the two in the middle",
     of_majority},
    {"minimum", "the least of each coordinate", of_minimum},
    {"maximum", "the greatest of each coordinate", of_maximum},
    {"pick", "each point of a copy drawn by lot", picked},
    {"mix", "pieces, six of each copy", mixed},
}};

[[noreturn]] void refuse_copy(std::size_t number, const std::string& reason) {
  throw Error(ErrorCode::Usage, {}, "", "copy " + std::to_string(number) + " " + reason);
}

// Returns the copy with its points numbered as those of the first.
Mesh numbered_alike(const Mesh& copy, const Mesh& first, std::size_t number) {
  if (copy.triangles.size() != first.triangles.size()) {
    refuse_copy(number, "has " + std::to_string(copy.triangles.size()) + " triangles, the first " +
                            std::to_string(first.triangles.size()));
  }
  if (copy.positions.size() != first.positions.size()) {
    refuse_copy(number, "has " + std::to_string(copy.positions.size()) + " points, the first " +
                            std::to_string(first.positions.size()));
  }
  constexpr std::uint32_t kNone = 0xffffffff;
  std::vector<std::uint32_t> point_of(first.positions.size(), kNone);
  for (std::size_t t = 0; t < first.triangles.size(); ++t) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      std::uint32_t& point = point_of[first.triangles[t][corner]];
      if (point == kNone) point = copy.triangles[t][corner];
      if (point != copy.triangles[t][corner]) {
        refuse_copy(number, "is connected otherwise than the first");
      }
    }
  }
  Mesh result{first.positions, first.triangles};
  for (std::size_t i = 0; i < point_of.size(); ++i) {
    // a point of no triangle has its own number
    result.positions[i] = copy.positions[point_of[i] == kNone ? i : point_of[i]];
  }
  return result;
}

}  // namespace

std::span<const CollusionKind> collusion_kinds() {
  return kCollusions;
}

const CollusionKind& collusion_kind(std::string_view name) {
  std::vector<std::string> names;
  for (const CollusionKind& kind : kCollusions) {
    if (kind.name == name) return kind;
    names.emplace_back(kind.name);
  }
  const auto meant = closest_word(name, names);
  throw Error(ErrorCode::Usage, {}, "",
              "unknown collusion \"" + std::string(name) + "\"" +
                  (meant ? "; did you mean " + *meant + "?" : ""));
}

Mesh colluded(std::span<const Mesh> copies, const CollusionKind& kind, std::uint64_t seed) {
  if (copies.size() < 2) {
    throw Error(ErrorCode::Usage, {}, "", "collusion takes two copies or more");
  }
  std::vector<Mesh> alike = {copies[0]};
  for (std::size_t k = 1; k < copies.size(); ++k) {
    alike.push_back(numbered_alike(copies[k], copies[0], k + 1));
  }
  return kind.combine(alike, seed);
}

}  // namespace triglyph
