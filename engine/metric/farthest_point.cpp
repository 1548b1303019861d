#include "engine/metric/farthest_point.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

#include "engine/base/error.h"
#include "engine/base/parallel.h"
#include "engine/base/stop.h"

namespace triglyph {
namespace {

constexpr std::size_t kTrianglesPerRound = 2048;
constexpr std::size_t kPiecesPerRound = 1024;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

using Column = std::array<double, 3>;

struct Corner {
  Vec3 point{0, 0, 0};
  double distance = kInfinity;
  std::uint32_t nearest = kNoTriangle;
};

// A triangle of the surface, or a part of one.
struct Piece {
  std::array<Corner, 3> corners;
  std::uint32_t middle = kNoTriangle;  // nearest to the middle of the whole triangle
  double upper = kInfinity;            // upper bound of the distance on the piece
  std::uint64_t number = 0;            // breaks ties
  int depth = 0;

  // the order of a heap whose top has the greatest bound
  bool operator<(const Piece& other) const {
    return upper != other.upper ? upper < other.upper : number > other.number;
  }
};

struct Parts {
  std::array<Piece, 3> pieces;
  std::size_t count = 0;

  void add(const std::array<Corner, 3>& corners) { pieces[count++].corners = corners; }
  [[nodiscard]] std::span<Piece> view() { return {pieces.data(), count}; }
  [[nodiscard]] std::span<const Piece> view() const { return {pieces.data(), count}; }
};

double greatest(const Column& column) {
  return std::max({column[0], column[1], column[2]});
}

// Returns the greatest entry of share * a + (1 - share) * b.
double greatest_of_mix(const Column& a, const Column& b, double share) {
  Column mix{};
  for (std::size_t i = 0; i < 3; ++i) mix[i] = share * a[i] + (1 - share) * b[i];
  return greatest(mix);
}

// Returns the least greatest_of_mix() over all shares: at an end, or where two of three lines
// cross.
double least_mix(const Column& a, const Column& b) {
  double least = std::min(greatest(a), greatest(b));
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const double slope = (a[i] - b[i]) - (a[j] - b[j]);
    const double share = (b[j] - b[i]) / slope;
    if (share > 0 && share < 1) least = std::min(least, greatest_of_mix(a, b, share));
  }
  return least;
}

// Returns the entry of the mean of three columns whose entries are all equal, by Cramer's rule;
// infinity if the weights of that mean are not all positive.
double level_mix(const Column& a, const Column& b, const Column& c) {
  const auto minor = [](const Column& p, const Column& q) {
    return (p[0] * q[1] - p[1] * q[0]) + (p[1] * q[2] - p[2] * q[1]) + (p[2] * q[0] - p[0] * q[2]);
  };
  const Column weights = {minor(b, c), minor(c, a), minor(a, b)};
  const double total = weights[0] + weights[1] + weights[2];
  const bool mixes = weights[0] / total > 0 && weights[1] / total > 0 && weights[2] / total > 0;
  if (!mixes) return kInfinity;
  Column mix{};
  for (std::size_t i = 0; i < 3; ++i) {
    mix[i] = (weights[0] * a[i] + weights[1] * b[i] + weights[2] * c[i]) / total;
  }
  return greatest(mix);
}

class BranchAndBound {
 public:
  BranchAndBound(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                 std::span<const double> reach, const SpatialIndex& surface,
                 const FarthestQuery& query)
      : positions_(positions),
        triangles_(triangles),
        reach_(reach),
        surface_(surface),
        query_(query) {}

  FarthestPoint run() {
    open_triangles();
    std::make_heap(pieces_.begin(), pieces_.end());
    std::size_t splits = 0;
    while (!pieces_.empty() && is_open(pieces_.front().upper) && splits < query_.most_splits) {
      splits += split_farthest_pieces();
    }
    if (!pieces_.empty()) close(pieces_.front().upper);
    best_.error = std::max(0.0, closed_ - best_.distance);
    return best_;
  }

 private:
  [[nodiscard]] bool is_open(double upper) const {
    return upper > best_.distance + query_.tolerance;
  }
  void close(double upper) { closed_ = std::max(closed_, upper); }

  void try_point(const Corner& corner) {
    if (corner.distance > best_.distance) best_ = {corner.distance, 0, corner.point};
  }

  // Turns triangles into pieces, in descending order of their bounds.
  void open_triangles() {
    std::vector<std::uint32_t> order(triangles_.size());
    std::iota(order.begin(), order.end(), 0U);
    parallel_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
      return reach_[a] != reach_[b] ? reach_[a] > reach_[b] : a < b;
    });
    corners_.assign(positions_.size(), {});
    for (std::size_t begin = 0; begin < order.size(); begin += kTrianglesPerRound) {
      if (!is_open(reach_[order[begin]])) {
        close(reach_[order[begin]]);
        return;
      }
      const std::size_t end = std::min(order.size(), begin + kTrianglesPerRound);
      open_some({order.data() + begin, order.data() + end});
    }
  }

  void open_some(std::span<const std::uint32_t> round) {
    evaluate_corners(round);
    std::vector<Piece> opened(round.size());
    std::vector<Corner> middles(round.size(), Corner{Vec3(0, 0, 0), 0, kNoTriangle});
    parallel_for(
        round.size(),
        [&](std::size_t i) {
          Piece& piece = opened[i];
          for (std::size_t c = 0; c < 3; ++c) {
            piece.corners[c] = corners_[triangles_[round[i]][c]];
          }
          piece.upper = std::min(reach_[round[i]], bound_of(piece));
          if (is_open(piece.upper)) middles[i] = look_at_middle(piece);
        },
        256);
    for (const Corner& middle : middles) try_point(middle);
    for (Piece& piece : opened) keep(piece);
  }

  // Finds the triangle nearest to the middle of a piece, and bounds the piece with it.
  [[nodiscard]] Corner look_at_middle(Piece& piece) const {
    const auto& [a, b, c] = piece.corners;
    Corner middle;
    middle.point = (a.point + b.point + c.point) / 3;
    evaluate(middle, std::min({surface_.distance_to(middle.point, a.nearest),
                               surface_.distance_to(middle.point, b.nearest),
                               surface_.distance_to(middle.point, c.nearest)}));
    piece.middle = middle.nearest;
    piece.upper = std::min(piece.upper, bound_of(piece));
    return middle;
  }

  // Computes the distances of the corners that have none yet.
  void evaluate_corners(std::span<const std::uint32_t> round) {
    std::vector<std::pair<std::uint32_t, double>> wanted;
    for (const std::uint32_t t : round) {
      for (const std::uint32_t point : triangles_[t]) {
        if (corners_[point].nearest != kNoTriangle) continue;
        wanted.emplace_back(point, reach_[t]);
        corners_[point].nearest = 0;  // queued
      }
    }
    parallel_blocks(
        wanted.size(),
        [&](std::size_t begin, std::size_t end) {
          std::uint32_t hint = kNoTriangle;
          for (std::size_t i = begin; i < end; ++i) {
            Corner& corner = corners_[wanted[i].first];
            corner.point = positions_[wanted[i].first];
            double reach = wanted[i].second;
            if (hint != kNoTriangle) {
              reach = std::min(reach, surface_.distance_to(corner.point, hint));
            }
            evaluate(corner, reach);
            hint = corner.nearest;
          }
        },
        256);
    for (const auto& [point, reach] : wanted) try_point(corners_[point]);
  }

  // Computes the distance of a corner. Precondition: it is at most `reach`, up to rounding.
  void evaluate(Corner& corner, double reach) const {
    ClosestPoint found = surface_.closest(corner.point, reach);
    if (found.triangle == kNoTriangle) found = surface_.closest(corner.point, kInfinity);
    corner.distance = found.distance;
    corner.nearest = found.triangle;
  }

  // Returns an upper bound on a piece. Precondition: the distances of its corners are known.
  [[nodiscard]] double bound_of(const Piece& piece) const {
    const auto& [a, b, c] = piece.corners;
    if (a.nearest == b.nearest && b.nearest == c.nearest) {
      return std::max({a.distance, b.distance, c.distance});
    }
    std::array<Column, 4> columns{};
    std::array<std::uint32_t, 4> triangles{};
    std::size_t count = 0;
    for (const std::uint32_t triangle : {a.nearest, b.nearest, c.nearest, piece.middle}) {
      const std::span<const std::uint32_t> known(triangles.data(), count);
      const bool is_known = std::find(known.begin(), known.end(), triangle) != known.end();
      if (triangle == kNoTriangle || is_known) continue;
      for (std::size_t i = 0; i < 3; ++i) {
        const Corner& corner = piece.corners[i];
        columns[count][i] = corner.nearest == triangle
                                ? corner.distance
                                : surface_.distance_to(corner.point, triangle);
      }
      triangles[count++] = triangle;
    }
    return least_greatest_mean({columns.data(), count});
  }

  // Adds a piece to the heap if its bound exceeds the distance found.
  bool keep(Piece& piece) {
    if (!is_open(piece.upper)) {
      close(piece.upper);
      return false;
    }
    piece.number = ++numbered_;
    pieces_.push_back(piece);
    return true;
  }

  // Splits the pieces with the greatest bounds. Returns their number.
  std::size_t split_farthest_pieces() {
    stop_point();
    std::vector<Piece> round;
    while (!pieces_.empty() && is_open(pieces_.front().upper) && round.size() < kPiecesPerRound) {
      std::pop_heap(pieces_.begin(), pieces_.end());
      round.push_back(pieces_.back());
      pieces_.pop_back();
    }
    std::vector<Parts> parts(round.size());
    parallel_for(
        round.size(), [&](std::size_t i) { parts[i] = split(round[i]); }, 32);
    for (const Parts& of_one : parts) {
      for (const Piece& part : of_one.view()) {
        for (const Corner& corner : part.corners) try_point(corner);
      }
    }
    for (Parts& of_one : parts) {
      for (Piece& part : of_one.view()) {
        if (keep(part)) std::push_heap(pieces_.begin(), pieces_.end());
      }
    }
    return round.size();
  }

  // Splits a piece, alternately where the prism of the nearest triangle ends and at the longest
  // edge. The former cuts coplanar surfaces into pieces under one triangle each; the latter makes
  // every piece shrink.
  [[nodiscard]] Parts split(const Piece& piece) const {
    Parts parts;
    if (piece.depth % 2 == 0) parts = cut_where_nearest_ends(piece);
    if (parts.count == 0) parts = halve(piece);
    for (Piece& part : parts.view()) {
      part.depth = piece.depth + 1;
      part.middle = piece.middle;
      part.upper = std::min(piece.upper, bound_of(part));
    }
    return parts;
  }

  // Returns the corner at a share of the way from a to b.
  [[nodiscard]] Corner corner_between(const Corner& a, const Corner& b, double share) const {
    Corner middle;
    middle.point = a.point + (b.point - a.point) * share;
    evaluate(middle, std::min(surface_.distance_to(middle.point, a.nearest),
                              surface_.distance_to(middle.point, b.nearest)));
    return middle;
  }

  [[nodiscard]] Parts halve(const Piece& piece) const {
    std::size_t opposite = 0;  // the corner across the longest edge
    double longest = -1;
    for (std::size_t i = 0; i < 3; ++i) {
      const double length =
          (piece.corners[(i + 1) % 3].point - piece.corners[(i + 2) % 3].point).sqrnorm();
      if (length > longest) {
        longest = length;
        opposite = i;
      }
    }
    const Corner& tip = piece.corners[opposite];
    const Corner& left = piece.corners[(opposite + 1) % 3];
    const Corner& right = piece.corners[(opposite + 2) % 3];
    const Corner middle = corner_between(left, right, 0.5);
    Parts parts;
    parts.add({middle, tip, left});
    parts.add({middle, right, tip});
    return parts;
  }

  // Cuts a piece at a side plane of the prism over the triangle nearest to one of its corners.
  // Returns nothing if no such plane intersects the piece.
  [[nodiscard]] Parts cut_where_nearest_ends(const Piece& piece) const {
    Column heights{};  // of the corners above the plane
    double deepest = 1e-9 * std::max((piece.corners[1].point - piece.corners[0].point).norm(),
                                     (piece.corners[2].point - piece.corners[0].point).norm());
    bool found = false;
    for (const Corner& corner : piece.corners) {
      for (std::size_t edge = 0; edge < 3; ++edge) {
        const Column over = heights_over(piece, surface_.prism_side(corner.nearest, edge));
        const double depth = std::min(greatest(over), -std::min({over[0], over[1], over[2]}));
        if (!(depth > deepest)) continue;
        deepest = depth;
        heights = over;
        found = true;
      }
    }
    return found ? cut(piece, heights) : Parts{};
  }

  [[nodiscard]] static Column heights_over(const Piece& piece, const Plane& plane) {
    Column heights{};
    for (std::size_t i = 0; i < 3; ++i) {
      heights[i] = dot(plane.normal, piece.corners[i].point - plane.point);
    }
    return heights;
  }

  // Cuts a piece where the heights, linear on it, are zero. Precondition: some are > 0 and some <
  // 0.
  [[nodiscard]] Parts cut(const Piece& piece, const Column& heights) const {
    const int above = static_cast<int>(
        std::count_if(heights.begin(), heights.end(), [](double height) { return height > 0; }));
    std::size_t tip = 0;  // the corner on the other side from the other two
    for (std::size_t i = 0; i < 3; ++i) {
      if ((heights[i] > 0) == (above == 1)) tip = i;
    }
    const std::size_t left = (tip + 1) % 3;
    const std::size_t right = (tip + 2) % 3;
    const auto on_edge_to = [&](std::size_t other) {
      return corner_between(piece.corners[tip], piece.corners[other],
                            heights[tip] / (heights[tip] - heights[other]));
    };
    const Corner a = on_edge_to(left);
    const Corner b = on_edge_to(right);
    Parts parts;
    parts.add({piece.corners[tip], a, b});
    parts.add({a, piece.corners[left], piece.corners[right]});
    parts.add({a, piece.corners[right], b});
    return parts;
  }

  std::span<const Vec3> positions_;
  std::span<const Triangle> triangles_;
  std::span<const double> reach_;
  const SpatialIndex& surface_;
  const FarthestQuery& query_;
  std::vector<Corner> corners_;  // of the triangles, where evaluated
  std::vector<Piece> pieces_;    // a heap once the triangles are opened
  std::uint64_t numbered_ = 0;
  FarthestPoint best_;
  double closed_ = 0;  // the greatest bound of pieces that were dropped
};

}  // namespace

double least_greatest_mean(std::span<const Column> columns) {
  double least = greatest(columns[0]);
  for (std::size_t i = 0; i < columns.size(); ++i) {
    for (std::size_t j = i + 1; j < columns.size(); ++j) {
      least = std::min(least, least_mix(columns[i], columns[j]));
      for (std::size_t k = j + 1; k < columns.size(); ++k) {
        least = std::min(least, level_mix(columns[i], columns[j], columns[k]));
      }
    }
  }
  return least;
}

FarthestPoint farthest_point(std::span<const Vec3> positions, std::span<const Triangle> here,
                             std::span<const double> reach, const SpatialIndex& surface,
                             const FarthestQuery& query) {
  check(reach.size() == here.size(), "one reach a triangle");
  return BranchAndBound(positions, here, reach, surface, query).run();
}

}  // namespace triglyph
