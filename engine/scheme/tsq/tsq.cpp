#include "engine/scheme/tsq/tsq.h"

#include <algorithm>
#include <optional>

#include "engine/base/error.h"
#include "engine/base/parallel.h"
#include "engine/scheme/cost_rows.h"
#include "engine/scheme/surface_binding.h"

namespace triglyph {
namespace {

using Quadruple = std::array<std::uint32_t, 6>;  // v0, v1, v2 of M from its base on, S, D1, D2

// All in units of the triangle's base.

// The plane of a flatter triangle, in which its points move, turns with every rounding of them.
constexpr double kMinHeight = 0.02;
// M's base stays so much longer than its other edges: readers know the base by its length, and
// rounding must not make another edge the longest.
constexpr double kLongestGap = 0.01;
// A point that had to move farther would be seen, and would flip a face as a rule.
constexpr double kMaxMoveInBases = 0.5;

constexpr int kMaxNumberBits = 8;  // two numbers share the bits of a channel, 16 at most

// Which corner of triangle `face` the longest edge leaves; the first of equals.
std::uint32_t longest_side(const Mesh& mesh, std::uint32_t face) {
  const Triangle& triangle = mesh.triangles[face];
  std::array<double, 3> squared{};
  for (std::uint32_t i = 0; i < 3; ++i) {
    squared[i] = (mesh.positions[triangle[(i + 1) % 3]] - mesh.positions[triangle[i]]).sqrnorm();
  }
  return static_cast<std::uint32_t>(std::max_element(squared.begin(), squared.end()) -
                                    squared.begin());
}

// The six points around a triangle, whose longest edge leaves corner `base`, in the order the
// scheme reads them; nothing at a boundary or where they are not six.
std::optional<Quadruple> quadruple_of(const Surface& surface, std::uint32_t face,
                                      std::uint32_t base) {
  const Halfedges& halfedges = surface.halfedges;
  const Triangle& triangle = surface.mesh.triangles[face];
  Quadruple points{triangle[base], triangle[(base + 1) % 3], triangle[(base + 2) % 3], 0, 0, 0};
  Halfedge side = halfedges.first_of_face(face);
  for (std::uint32_t i = 0; i < base; ++i) side = halfedges.next(side);
  for (std::size_t i = 3; i < 6; ++i) {
    const Halfedge across = halfedges.opposite(side);
    if (halfedges.is_boundary(across)) return std::nullopt;
    points[i] = halfedges.to(halfedges.next(across));
    side = halfedges.next(side);
  }
  // the apexes differ from M's corners by construction unless two faces share all their points
  for (std::size_t i = 3; i < 6; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (points[i] == points[j]) return std::nullopt;
    }
  }
  return points;
}

// The same six points as a surface has them whose triangles are wound the other way.
Quadruple turned_over(const Quadruple& points) {
  return {points[1], points[0], points[2], points[3], points[5], points[4]};
}

// The outer triangle on side i of M, its base as the outer triangle runs along it.
FlatTriangle outer_triangle(const std::array<Vec3, 3>& corners, std::size_t i, const Vec3& apex) {
  return flatten(corners[(i + 1) % 3], corners[i], apex);
}

bool keeps_longest_base(double x, double height) {
  const double start = x * x + height * height;
  const double end = (x - 1) * (x - 1) + height * height;
  return std::max(start, end) <= (1 - kLongestGap) * (1 - kLongestGap);
}

// note: std::hypot guards against overflow that cannot occur here, at ten times the cost
double length(double x, double y) {
  return std::sqrt(x * x + y * y);
}

// f(value) for each of the values; where they have few bits, worked out once for each.
template <typename F>
std::vector<float> values_of_each(int bits, std::span<const std::uint32_t> values, const F& f) {
  std::vector<float> known;
  if (std::size_t{1} << bits <= values.size()) {
    known.resize(std::size_t{1} << bits);
    for (std::uint32_t value = 0; value < known.size(); ++value) known[value] = f(value);
  }
  std::vector<float> results(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    results[i] = known.empty() ? f(values[i]) : known[values[i]];
  }
  return results;
}

// Directions along a base and from it towards an apex, unit vectors.
struct Frame {
  Vec3 origin, along, up;
  Frame(const Vec3& start, const Vec3& end, const Vec3& apex) : origin(start) {
    along = (end - start).normalized();
    const Vec3 side = apex - start;
    up = (side - along * dot(along, side)).normalized();
  }
  [[nodiscard]] Vec3 at(double x, double y) const { return origin + along * x + up * y; }
};

}  // namespace

// The apexes that carry each value of a channel, for one triangle. The nearest cell of the height
// and the nearest of the ratio are tried first; only where no triangle has that shape, or the
// caller refuses it, the next cells on the other side.
class TsqScheme::ApexChoices {
 public:
  ApexChoices(const FlatTriangle& triangle, const Channel& channel)
      : triangle_(triangle), channel_(channel), shape_(triangle.shape()) {}

  // Calls accept(x, height), both in units of the base, for legal apexes; the cells behind the
  // nearest are tried only if it is not accepted.
  template <typename Accept>
  void for_each_cell(std::uint32_t bits, const Accept& accept) const {
    const std::uint32_t height_bits = channel_.height_bits(bits);
    const std::uint32_t ratio_bits = channel_.ratio_bits(bits);
    const double height = near_height(height_bits);
    const double ratio = channel_.log_ratio.nearest_centre(shape_.log_ratio, ratio_bits);
    const auto consider = [&](double h, double tanh_ratio) {
      if (h < kMinHeight) return false;
      const std::optional<double> x = apex_x(h, tanh_ratio, triangle_.x);
      return x && accept(*x, h);
    };
    if (consider(height, std::tanh(ratio))) return;
    const double next_height = channel_.height.second_centre(shape_.height, height);
    const double next_ratio = channel_.log_ratio.second_centre(shape_.log_ratio, ratio);
    consider(height, std::tanh(next_ratio));
    consider(next_height, std::tanh(ratio));
    consider(next_height, std::tanh(next_ratio));
  }

  // The apex for these bits, or nothing if it is farther than kMaxMoveInBases bases away.
  [[nodiscard]] std::optional<Apex> place(std::uint32_t bits) const {
    std::optional<Apex> best;
    double best_move = kMaxMoveInBases;
    for_each_cell(bits, [&](double x, double height) {
      const double move = length(x - triangle_.x, height - triangle_.height);
      if (move >= best_move) return false;
      best_move = move;
      best = Apex{x, height, move * triangle_.base};
      return true;
    });
    return best;
  }

 private:
  [[nodiscard]] double near_height(std::uint32_t bits) const {
    return channel_.height.nearest_centre(shape_.height, bits);
  }

  const FlatTriangle& triangle_;
  const Channel& channel_;
  TriangleShape shape_;
};

// The moves of one triangle's apex for many values of its channel: place() with the nearest cells
// tabulated, since a channel has few heights and few ratios but many pairs of them.
class TsqScheme::ApexMoves {
 public:
  ApexMoves(const FlatTriangle& triangle, const Channel& channel)
      : triangle_(triangle), channel_(channel), choices_(triangle, channel) {
    const TriangleShape shape = triangle.shape();
    for (std::uint32_t bits = 0; bits < 1U << channel.height.bits(); ++bits) {
      heights_[bits] = channel.height.nearest_centre(shape.height, bits);
    }
    for (std::uint32_t bits = 0; bits < 1U << channel.log_ratio.bits(); ++bits) {
      tanh_ratios_[bits] = std::tanh(channel.log_ratio.nearest_centre(shape.log_ratio, bits));
    }
  }

  // Model units; kInfeasible where the apex cannot be placed.
  [[nodiscard]] float move(std::uint32_t bits) const {
    const double height = heights_[channel_.height_bits(bits)];
    const double tanh_ratio = tanh_ratios_[channel_.ratio_bits(bits)];
    if (height >= kMinHeight) {
      const std::optional<double> x = apex_x(height, tanh_ratio, triangle_.x);
      if (x) {
        const double move = length(*x - triangle_.x, height - triangle_.height);
        if (move < kMaxMoveInBases) return static_cast<float>(move * triangle_.base);
      }
    }
    const std::optional<Apex> apex = choices_.place(bits);
    return apex ? static_cast<float>(apex->move) : kInfeasible;
  }

 private:
  const FlatTriangle& triangle_;
  const Channel& channel_;
  ApexChoices choices_;
  std::array<double, std::size_t{1} << kMaxNumberBits> heights_;
  std::array<double, std::size_t{1} << kMaxNumberBits> tanh_ratios_;
};

// The scheme on one surface.
class TsqScheme::Bound final : public SurfaceBinding {
 public:
  Bound(const TsqScheme& scheme, const Surface& surface)
      : SurfaceBinding(surface, scheme.options_), scheme_(scheme) {}

  [[nodiscard]] UnitSet find_units() const override;
  [[nodiscard]] CostMatrix costs(const UnitSet& units, std::span<const std::uint32_t> chosen,
                                 std::span<const Word> words) const override;
  [[nodiscard]] Embedding embed(const UnitSet& units, std::span<const Placement> placements,
                                std::span<const Word> words) const override;
  [[nodiscard]] std::vector<Reading> read() const override { return read_wound(Winding::AsIs); }
  [[nodiscard]] std::vector<std::vector<Reading>> read_turned_over() const override {
    return {read_wound(Winding::TurnedOver)};
  }
  [[nodiscard]] std::vector<Reading> read_at(std::span<const std::uint32_t> anchors) const override;
  [[nodiscard]] PointLists points_of(std::span<const std::uint32_t> anchors) const override;
  [[nodiscard]] std::unique_ptr<BoundScheme> moved_to(const Surface& moved) const override {
    return std::make_unique<Bound>(scheme_, moved);
  }

 private:
  // Lengths do not tell a surface from its mirror image, so that mirroring shows in the winding or
  // not at all.
  enum class Winding { AsIs, TurnedOver };

  [[nodiscard]] std::vector<Reading> read_wound(Winding winding) const;
  // Appends what a triangle shows, if it shows the marker.
  void read_face(std::uint32_t face, Winding winding, std::vector<Reading>& out) const;

  const TsqScheme& scheme_;
};

std::unique_ptr<BoundScheme> TsqScheme::bind(const Surface& surface) const {
  return std::make_unique<Bound>(*this, surface);
}

TsqScheme::Channel TsqScheme::make_channel(const WordCode& code, double step, int bits,
                                           std::size_t role) {
  const int height_bits = bits / 2;
  return {Quantiser(step, height_bits, code.offset(2 * role)),
          Quantiser(step, bits - height_bits, code.offset(2 * role + 1))};
}

TsqScheme::TsqScheme(const WordCode& code, const TsqOptions& options)
    : options_(options),
      marker_(code.marker()),
      marker_channel_(make_channel(code, options.step, code.format().marker_bits, 0)),
      outer_channels_{make_channel(code, options.step, code.format().subscript_bits, 1),
                      make_channel(code, options.step, code.format().part_bits / 2, 2),
                      make_channel(code, options.step,
                                   code.format().part_bits - code.format().part_bits / 2, 3)} {
  if (!(options.step > 0 && options.step <= 0.5)) {
    throw Error(ErrorCode::Usage, {}, "", "the cell width of tsq lies above 0 and up to 0.5");
  }
}

std::optional<FlatCorners> TsqScheme::reshape_to_marker(const FlatTriangle& triangle) const {
  const ApexChoices choices(triangle, marker_channel_);
  std::optional<FlatCorners> best;
  double best_move = kMaxMoveInBases * triangle.base;
  choices.for_each_cell(marker_, [&](double x, double height) {
    if (!keeps_longest_base(x, height)) return false;
    const FlatCorners moved = reshape(triangle, x, height);
    const double move =
        std::max({length(moved.x[0], moved.y[0]), length(moved.x[1] - triangle.base, moved.y[1]),
                  length(moved.x[2] - triangle.base * triangle.x,
                         moved.y[2] - triangle.base * triangle.height)});
    if (move >= best_move) return false;
    best_move = move;
    best = moved;
    return true;
  });
  return best;
}

std::optional<TsqScheme::Marked> TsqScheme::embed_marker(
    const Mesh& mesh, std::span<const std::uint32_t> points) const {
  const std::array<Vec3, 3> corners{mesh.positions[points[0]], mesh.positions[points[1]],
                                    mesh.positions[points[2]]};
  const FlatTriangle triangle = flatten(corners[0], corners[1], corners[2]);
  if (!(triangle.base > 0 && triangle.height >= kMinHeight)) return std::nullopt;
  const std::optional<FlatCorners> flat = reshape_to_marker(triangle);
  if (!flat) return std::nullopt;

  const Frame frame(corners[0], corners[1], corners[2]);
  Marked marked;
  for (std::size_t i = 0; i < 3; ++i) {
    marked.corners[i] = frame.at(flat->x[i], flat->y[i]);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    marked.outer[i] = outer_triangle(marked.corners, i, mesh.positions[points[3 + i]]);
    if (!(marked.outer[i].height >= kMinHeight)) return std::nullopt;
  }
  return marked;
}

std::array<std::uint32_t, 3> TsqScheme::outer_bits(const Word& word) const {
  const int first = outer_channels_[1].bits();
  return {word.subscript, word.part & ((1U << first) - 1), word.part >> first};
}

UnitSet TsqScheme::Bound::find_units() const {
  struct Found {
    std::uint32_t face;
    Quadruple points;
  };
  const auto found = parallel_collect<Found>(
      mesh().triangles.size(), [&](std::size_t face, std::vector<Found>& out) {
        const auto points = quadruple_of(surface(), static_cast<std::uint32_t>(face),
                                         longest_side(mesh(), static_cast<std::uint32_t>(face)));
        if (points && scheme_.embed_marker(mesh(), *points)) {
          out.push_back({static_cast<std::uint32_t>(face), *points});
        }
      });
  UnitSet units;
  units.anchors.reserve(found.size());
  units.moved.offsets.reserve(found.size() + 1);
  units.moved.points.reserve(6 * found.size());
  for (const Found& unit : found) {
    units.anchors.push_back(unit.face);
    units.moved.points.insert(units.moved.points.end(), unit.points.begin(), unit.points.end());
    units.moved.offsets.push_back(static_cast<std::uint32_t>(units.moved.points.size()));
  }
  return units;
}

std::optional<Vec3> TsqScheme::place_apex(const Mesh& mesh, std::span<const std::uint32_t> points,
                                          const Marked& marked, std::size_t i,
                                          std::uint32_t bits) const {
  const FlatTriangle& triangle = marked.outer[i];
  const std::optional<Apex> apex = ApexChoices(triangle, outer_channels_[i]).place(bits);
  if (!apex) return std::nullopt;
  const Frame frame(marked.corners[(i + 1) % 3], marked.corners[i], mesh.positions[points[3 + i]]);
  return frame.at(apex->x * triangle.base, apex->height * triangle.base);
}

CostMatrix TsqScheme::Bound::costs(const UnitSet& units, std::span<const std::uint32_t> chosen,
                                   std::span<const Word> words) const {
  std::array<std::vector<std::uint32_t>, 3> values;  // of S, D1 and D2 in every word
  for (const Word& word : words) {
    const auto bits = scheme_.outer_bits(word);
    for (std::size_t i = 0; i < 3; ++i) values[i].push_back(bits[i]);
  }
  const LocalCost& local = local_cost();
  return fill_cost_rows(chosen.size(), words.size(), [&](std::size_t row, std::span<float> costs) {
    const auto points = units.moved[chosen[row]];
    const auto marked = scheme_.embed_marker(mesh(), points);
    if (!marked) return;
    const std::array<Move, 3> corners{{{points[0], marked->corners[0]},
                                       {points[1], marked->corners[1]},
                                       {points[2], marked->corners[2]}}};
    const float marker = local.of_part(corners);
    std::array<std::vector<float>, 3> parts;
    for (std::size_t i = 0; i < 3; ++i) {
      const ApexMoves moves(marked->outer[i], scheme_.outer_channels_[i]);
      parts[i] =
          values_of_each(scheme_.outer_channels_[i].bits(), values[i], [&](std::uint32_t bits) {
            if (local.goes_by_distance()) return local.of_distance(moves.move(bits));
            const auto apex = scheme_.place_apex(mesh(), points, *marked, i, bits);
            return apex ? local.of_part(std::array<Move, 1>{{{points[3 + i], *apex}}})
                        : kInfeasible;
          });
    }
    for (std::size_t word = 0; word < costs.size(); ++word) {
      const std::array<float, 4> unit{marker, parts[0][word], parts[1][word], parts[2][word]};
      costs[word] = local.combine(unit, 6);
    }
  });
}

Embedding TsqScheme::Bound::embed(const UnitSet& units, std::span<const Placement> placements,
                                  std::span<const Word> words) const {
  return embed_each(placements.size(), [&](std::size_t index, std::vector<Vec3>& positions) {
    const auto points = units.moved[placements[index].unit];
    const std::optional<Marked> marked = scheme_.embed_marker(mesh(), points);
    if (!marked) return false;
    const auto bits = scheme_.outer_bits(words[placements[index].word]);
    std::array<Vec3, 3> apexes;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto apex = scheme_.place_apex(mesh(), points, *marked, i, bits[i]);
      if (!apex) return false;
      apexes[i] = *apex;
    }
    for (std::size_t i = 0; i < 3; ++i) {
      positions[points[i]] = marked->corners[i];
      positions[points[3 + i]] = apexes[i];
    }
    return true;
  });
}

bool TsqScheme::has_marker(const FlatTriangle& triangle, Reading& reading) const {
  const auto height = marker_channel_.height.cell_of(triangle.height);
  if (height.bits != marker_channel_.height_bits(marker_)) return false;
  const auto log_ratio = marker_channel_.log_ratio.cell_of(triangle.shape().log_ratio);
  if (log_ratio.bits != marker_channel_.ratio_bits(marker_)) return false;
  reading.worst_offset = std::max(height.distance, log_ratio.distance);
  reading.weight = (1 - height.distance) * (1 - log_ratio.distance);
  return true;
}

void TsqScheme::read_outer(const Mesh& mesh, const Quadruple& points, Reading& reading) const {
  const std::array<Vec3, 3> corners{mesh.positions[points[0]], mesh.positions[points[1]],
                                    mesh.positions[points[2]]};
  std::array<std::uint32_t, 3> bits{};
  std::size_t part_bit = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Channel& channel = outer_channels_[i];
    const TriangleShape shape = outer_triangle(corners, i, mesh.positions[points[3 + i]]).shape();
    const auto height = channel.height.cell_of(shape.height);
    const auto log_ratio = channel.log_ratio.cell_of(shape.log_ratio);
    bits[i] = height.bits | log_ratio.bits << channel.height.bits();
    reading.worst_offset = std::max({reading.worst_offset, height.distance, log_ratio.distance});
    reading.weight *= (1 - height.distance) * (1 - log_ratio.distance);
    if (i == 0) continue;
    for (int b = 0; b < channel.bits(); ++b) {
      const float distance = b < channel.height.bits() ? height.distance : log_ratio.distance;
      reading.bit_weights[part_bit++] = 1 - distance;
    }
  }
  reading.word = {bits[0], bits[1] | bits[2] << outer_channels_[1].bits()};
}

void TsqScheme::Bound::read_face(std::uint32_t face, Winding winding,
                                 std::vector<Reading>& out) const {
  Reading reading;
  reading.anchor = face;
  const std::uint32_t base = longest_side(mesh(), face);
  const auto corner = [&](std::uint32_t i) -> const Vec3& {
    return mesh().positions[mesh().triangles[face][(base + i) % 3]];
  };
  const bool is_turned = winding == Winding::TurnedOver;
  const FlatTriangle triangle = is_turned ? flatten(corner(1), corner(0), corner(2))
                                          : flatten(corner(0), corner(1), corner(2));
  if (!scheme_.has_marker(triangle, reading)) return;  // most faces end here
  auto points = quadruple_of(surface(), face, base);
  if (!points) return;
  if (is_turned) points = turned_over(*points);
  scheme_.read_outer(mesh(), *points, reading);
  if (std::isfinite(reading.weight)) out.push_back(reading);
}

std::vector<Reading> TsqScheme::Bound::read_wound(Winding winding) const {
  return parallel_collect<Reading>(mesh().triangles.size(),
                                   [&](std::size_t face, std::vector<Reading>& out) {
                                     read_face(static_cast<std::uint32_t>(face), winding, out);
                                   });
}

std::vector<Reading> TsqScheme::Bound::read_at(std::span<const std::uint32_t> anchors) const {
  return parallel_collect<Reading>(anchors.size(), [&](std::size_t i, std::vector<Reading>& out) {
    if (anchors[i] < mesh().triangles.size()) read_face(anchors[i], Winding::AsIs, out);
  });
}

PointLists TsqScheme::Bound::points_of(std::span<const std::uint32_t> anchors) const {
  PointLists lists;
  for (const std::uint32_t face : anchors) {
    std::optional<Quadruple> points;
    if (face < mesh().triangles.size()) {
      points = quadruple_of(surface(), face, longest_side(mesh(), face));
    }
    if (points) std::sort(points->begin(), points->end());
    lists.append(points ? std::span<const std::uint32_t>(*points)
                        : std::span<const std::uint32_t>());
  }
  return lists;
}

}  // namespace triglyph
