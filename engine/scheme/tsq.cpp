#include "engine/scheme/tsq.h"

#include <algorithm>
#include <optional>

#include "engine/base/error.h"
#include "engine/base/parallel.h"

namespace triglyph {
namespace {

using Quadruple = std::array<std::uint32_t, 6>;  // v0, v1, v2 of M from its base on, S, D1, D2

// All in units of the triangle's base.
constexpr double kMinHeight = 0.02;       // flatter triangles have no stable plane to move in
constexpr double kLongestGap = 0.01;      // the base stays this much longer than the other edges
constexpr double kMaxMove = 0.5;          // a cell farther away is not worth a unit
constexpr std::size_t kUnitsPerBlock = 16;  // rows of the cost matrix computed together

// Which corner of triangle `face` the longest edge leaves; the first of equals.
std::uint32_t longest_side(const Mesh& mesh, std::uint32_t face) {
  const Triangle& triangle = mesh.triangles[face];
  std::array<double, 3> squared{};
  for (std::uint32_t i = 0; i < 3; ++i) {
    squared[i] =
        (mesh.positions[triangle[(i + 1) % 3]] - mesh.positions[triangle[i]]).sqrnorm();
  }
  return static_cast<std::uint32_t>(std::max_element(squared.begin(), squared.end()) -
                                    squared.begin());
}

// The six points around a triangle in the order the scheme reads them; nothing at a boundary or
// where they are not six.
std::optional<Quadruple> quadruple_of(const Surface& surface, std::uint32_t face) {
  const auto& kernel = surface.halfedges.kernel;
  const std::uint32_t base = longest_side(surface.mesh, face);
  const Triangle& triangle = surface.mesh.triangles[face];
  Quadruple points{triangle[base], triangle[(base + 1) % 3], triangle[(base + 2) % 3], 0, 0, 0};
  auto side = kernel.halfedge_handle(OpenMesh::FaceHandle(static_cast<int>(face)));
  for (std::uint32_t i = 0; i < base; ++i) side = kernel.next_halfedge_handle(side);
  for (std::size_t i = 3; i < 6; ++i) {
    const auto across = kernel.opposite_halfedge_handle(side);
    if (kernel.is_boundary(across)) return std::nullopt;
    points[i] = surface.halfedges.point(
        kernel.to_vertex_handle(kernel.next_halfedge_handle(across)));
    side = kernel.next_halfedge_handle(side);
  }
  // the apexes differ from M's corners by construction unless two faces share all their points
  for (std::size_t i = 3; i < 6; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (points[i] == points[j]) return std::nullopt;
    }
  }
  return points;
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
double length(double x, double y) { return std::sqrt(x * x + y * y); }

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

TsqScheme::Channel TsqScheme::make_channel(const WordCode& code, double step, int bits,
                                           std::size_t role) {
  const int height_bits = bits / 2;
  return {Quantiser(step, height_bits, code.offset(2 * role)),
          Quantiser(step, bits - height_bits, code.offset(2 * role + 1))};
}

TsqScheme::TsqScheme(const WordCode& code, const SchemeOptions& options)
    : options_(options),
      marker_(code.marker()),
      marker_channel_(make_channel(code, options.step, code.format().marker_bits, 0)),
      outer_channels_{
          make_channel(code, options.step, code.format().subscript_bits, 1),
          make_channel(code, options.step, code.format().part_bits / 2, 2),
          make_channel(code, options.step,
                       code.format().part_bits - code.format().part_bits / 2, 3)} {
  if (!(options.step > 0 && options.step <= 0.5)) {
    throw Error(ErrorCode::Usage, {}, "", "the cell width of tsq lies above 0 and up to 0.5");
  }
}

// The four nearest cells that carry the marker, two a number; the cheapest legal one.
std::optional<FlatCorners> TsqScheme::cheapest_marker(const FlatTriangle& triangle) const {
  const TriangleShape shape = triangle.shape();
  const auto& [height, log_ratio] = marker_channel_;
  const double near_height = height.nearest_centre(shape.height,
                                                   marker_channel_.height_bits(marker_));
  const double near_ratio =
      log_ratio.nearest_centre(shape.log_ratio, marker_channel_.ratio_bits(marker_));
  std::optional<FlatCorners> best;
  double best_move = kMaxMove * triangle.base;
  for (const double h : {near_height, height.second_centre(shape.height, near_height)}) {
    if (h < kMinHeight) continue;
    for (const double r : {near_ratio, log_ratio.second_centre(shape.log_ratio, near_ratio)}) {
      const std::optional<double> x = apex_x(h, std::tanh(r), triangle.x);
      if (!x || !keeps_longest_base(*x, h)) continue;
      const FlatCorners moved = reshape(triangle, *x, h);
      const double move = std::max({length(moved.x[0], moved.y[0]),
                                    length(moved.x[1] - triangle.base, moved.y[1]),
                                    length(moved.x[2] - triangle.base * triangle.x,
                                           moved.y[2] - triangle.base * triangle.height)});
      if (move < best_move) {
        best_move = move;
        best = moved;
      }
    }
  }
  return best;
}

std::optional<TsqScheme::Marked> TsqScheme::embed_marker(
    const Mesh& mesh, std::span<const std::uint32_t> points) const {
  const std::array<Vec3, 3> corners{mesh.positions[points[0]], mesh.positions[points[1]],
                                    mesh.positions[points[2]]};
  const FlatTriangle triangle = flatten(corners[0], corners[1], corners[2]);
  if (!(triangle.base > 0 && triangle.height >= kMinHeight)) return std::nullopt;
  const std::optional<FlatCorners> flat = cheapest_marker(triangle);
  if (!flat) return std::nullopt;

  const Frame frame(corners[0], corners[1], corners[2]);
  Marked marked;
  for (std::size_t i = 0; i < 3; ++i) {
    marked.corners[i] = frame.at(flat->x[i], flat->y[i]);
    const double squared = (marked.corners[i] - corners[i]).sqrnorm();
    marked.sum_of_squares += squared;
    marked.farthest = std::max(marked.farthest, std::sqrt(squared));
  }
  for (std::size_t i = 0; i < 3; ++i) {
    marked.outer[i] = outer_triangle(marked.corners, i, mesh.positions[points[3 + i]]);
    if (!(marked.outer[i].height >= kMinHeight)) return std::nullopt;
  }
  return marked;
}

// The nearest cells of the wanted bits; where no triangle has that shape, the next cells of each
// number, the nearest legal apex of them.
std::optional<TsqScheme::Apex> TsqScheme::place_apex(const FlatTriangle& triangle,
                                                     const Channel& channel, std::uint32_t bits) {
  const TriangleShape shape = triangle.shape();
  const double near_height =
      channel.height.nearest_centre(shape.height, channel.height_bits(bits));
  const double near_ratio =
      channel.log_ratio.nearest_centre(shape.log_ratio, channel.ratio_bits(bits));
  std::optional<Apex> best;
  double best_move = kMaxMove;
  const auto consider = [&](double height, double log_ratio) {
    if (height < kMinHeight) return;
    const std::optional<double> x = apex_x(height, std::tanh(log_ratio), triangle.x);
    if (!x) return;
    const double move = length(*x - triangle.x, height - triangle.height);
    if (move >= best_move) return;
    best_move = move;
    best = Apex{*x, height, move * triangle.base};
  };
  consider(near_height, near_ratio);
  if (best) return best;
  const double next_height = channel.height.second_centre(shape.height, near_height);
  const double next_ratio = channel.log_ratio.second_centre(shape.log_ratio, near_ratio);
  consider(near_height, next_ratio);
  consider(next_height, near_ratio);
  consider(next_height, next_ratio);
  return best;
}

std::array<std::uint32_t, 3> TsqScheme::outer_bits(const Word& word) const {
  const int first = outer_channels_[1].bits();
  return {word.subscript, word.part & ((1U << first) - 1), word.part >> first};
}

UnitSet TsqScheme::find_units(const Surface& surface) const {
  struct Found {
    std::uint32_t face;
    Quadruple points;
  };
  const auto found = parallel_collect<Found>(
      surface.mesh.triangles.size(), [&](std::size_t face, std::vector<Found>& out) {
        const auto points = quadruple_of(surface, static_cast<std::uint32_t>(face));
        if (points && embed_marker(surface.mesh, *points)) {
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

float TsqScheme::combine(const Marked& marked, float s, float d1, float d2) const {
  if (options_.cost == CostFunction::Displacement) {
    return std::max({static_cast<float>(marked.farthest), s, d1, d2});
  }
  const float sum = static_cast<float>(marked.sum_of_squares) + s * s + d1 * d1 + d2 * d2;
  return std::sqrt(sum / 6);
}

CostMatrix TsqScheme::costs(const Surface& surface, const UnitSet& units,
                            std::span<const std::uint32_t> chosen,
                            std::span<const Word> words) const {
  CostMatrix matrix{static_cast<std::uint32_t>(chosen.size()),
                    static_cast<std::uint32_t>(words.size()), {}};
  matrix.values.resize(chosen.size() * words.size());
  const auto move_for = [](const FlatTriangle& triangle, const Channel& channel,
                           std::uint32_t bits) {
    const std::optional<Apex> apex = place_apex(triangle, channel, bits);
    return apex ? static_cast<float>(apex->move) : kInfeasible;
  };
  const auto fill_row = [&](std::size_t row) {
    const std::optional<Marked> marked = embed_marker(surface.mesh, units.moved[chosen[row]]);
    // the part's two halves take few values, so they are tabulated; subscripts are many and distinct
    std::array<std::vector<float>, 2> data;
    for (std::size_t d = 0; marked && d < 2; ++d) {
      data[d].resize(std::size_t{1} << outer_channels_[1 + d].bits());
      for (std::uint32_t bits = 0; bits < data[d].size(); ++bits) {
        data[d][bits] = move_for(marked->outer[1 + d], outer_channels_[1 + d], bits);
      }
    }
    for (std::size_t column = 0; column < words.size(); ++column) {
      float& cost = matrix.values[column * chosen.size() + row];
      if (!marked) {
        cost = kInfeasible;
        continue;
      }
      const auto bits = outer_bits(words[column]);
      cost = combine(*marked, move_for(marked->outer[0], outer_channels_[0], bits[0]),
                     data[0][bits[1]], data[1][bits[2]]);
    }
  };
  parallel_for(chosen.size(), fill_row, kUnitsPerBlock);
  return matrix;
}

Embedding TsqScheme::embed(const Surface& surface, const UnitSet& units,
                           std::span<const Placement> placements,
                           std::span<const Word> words) const {
  Embedding embedding{surface.mesh.positions, {}};
  const auto place = [&](const Placement& placement) {
    const auto points = units.moved[placement.unit];
    const std::optional<Marked> marked = embed_marker(surface.mesh, points);
    if (!marked) return false;
    const auto bits = outer_bits(words[placement.word]);
    std::array<Vec3, 3> apexes;
    for (std::size_t i = 0; i < 3; ++i) {
      const FlatTriangle& triangle = marked->outer[i];
      const std::optional<Apex> apex = place_apex(triangle, outer_channels_[i], bits[i]);
      if (!apex) return false;
      const Frame frame(marked->corners[(i + 1) % 3], marked->corners[i],
                        surface.mesh.positions[points[3 + i]]);
      apexes[i] = frame.at(apex->x * triangle.base, apex->height * triangle.base);
    }
    for (std::size_t i = 0; i < 3; ++i) {
      embedding.positions[points[i]] = marked->corners[i];
      embedding.positions[points[3 + i]] = apexes[i];
    }
    return true;
  };
  std::vector<char> placed(placements.size());
  parallel_for(
      placements.size(), [&](std::size_t i) { placed[i] = place(placements[i]) ? 1 : 0; },
      kUnitsPerBlock);
  for (std::uint32_t i = 0; i < placements.size(); ++i) {
    if (placed[i] == 0) embedding.failed.push_back(i);
  }
  return embedding;
}

bool TsqScheme::has_marker(const Mesh& mesh, const Quadruple& points, Reading& reading) const {
  const FlatTriangle triangle = flatten(mesh.positions[points[0]], mesh.positions[points[1]],
                                        mesh.positions[points[2]]);
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
    const TriangleShape shape =
        outer_triangle(corners, i, mesh.positions[points[3 + i]]).shape();
    const auto height = channel.height.cell_of(shape.height);
    const auto log_ratio = channel.log_ratio.cell_of(shape.log_ratio);
    bits[i] = height.bits | log_ratio.bits << channel.height.bits();
    reading.worst_offset =
        std::max({reading.worst_offset, height.distance, log_ratio.distance});
    reading.weight *= (1 - height.distance) * (1 - log_ratio.distance);
    if (i == 0) continue;
    for (int b = 0; b < channel.bits(); ++b) {
      const float distance = b < channel.height.bits() ? height.distance : log_ratio.distance;
      reading.bit_weights[part_bit++] = 1 - distance;
    }
  }
  reading.word = {bits[0], bits[1] | bits[2] << outer_channels_[1].bits()};
}

std::vector<Reading> TsqScheme::read(const Surface& surface) const {
  return parallel_collect<Reading>(
      surface.mesh.triangles.size(), [&](std::size_t face, std::vector<Reading>& out) {
        Reading reading;
        reading.anchor = static_cast<std::uint32_t>(face);
        const auto points = quadruple_of(surface, reading.anchor);
        if (!points || !has_marker(surface.mesh, *points, reading)) return;
        read_outer(surface.mesh, *points, reading);
        if (std::isfinite(reading.weight)) out.push_back(reading);
      });
}

}  // namespace triglyph
