#include "engine/marking/kept_shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string_view>

#include "engine/align/alignment.h"
#include "engine/io/packed_mesh.h"
#include "engine/mesh/fewer_triangles.h"

namespace triglyph {
namespace {

// Triangles of the coarse surface. With a third as many, a cropped copy leaves half the evidence.
constexpr std::size_t kCoarseTriangles = 20'000;

// Points whose landmarks are kept, at most: an alignment needs some dozens of them in the piece.
constexpr std::size_t kMostLandmarks = 1000;

struct Landmark {
  std::uint64_t point = 0;
  std::uint64_t number = 0;
};

constexpr std::string_view kShapeMagic = "TGSHAPE1";

// The numbers of a solid, in the order in which they are stored.
template <typename Solid, typename Visit>
void for_each_number(Solid& solid, const Visit& visit) {
  for (std::size_t axis = 0; axis < 3; ++axis) visit(solid.frame.centre[axis]);
  visit(solid.frame.scale);
  for (auto& axis : solid.frame.axes) {
    for (std::size_t i = 0; i < 3; ++i) visit(axis[i]);
  }
  for (auto& spread : solid.frame.spreads) visit(spread);
  visit(solid.frame.orientation);
  for (auto& value : solid.values.flux) visit(value);
  for (auto& value : solid.values.weight) visit(value);
}

}  // namespace

std::optional<KeptShape> KeptShape::of(const Surface& surface) {
  const std::optional<FluxSolid> solid = FluxSolid::of(surface);
  if (!solid) return std::nullopt;
  const Mesh& mesh = surface.mesh;
  const std::vector<std::uint64_t> numbers = triglyph::landmarks(mesh);
  KeptShape shape{*solid, {}, {}};
  constexpr std::uint32_t kUnused = 0xffffffff;
  std::vector<std::uint32_t> place(mesh.positions.size(), kUnused);
  for (const Triangle& t : clustered(mesh, kCoarseTriangles)) {
    Triangle& kept = shape.coarse.triangles.emplace_back();
    for (std::size_t corner = 0; corner < 3; ++corner) {
      std::uint32_t& point = place[t[corner]];
      if (point == kUnused) {
        point = static_cast<std::uint32_t>(shape.coarse.positions.size());
        shape.coarse.positions.push_back(mesh.positions[t[corner]]);
        shape.landmarks.push_back(numbers[t[corner]]);
      }
      kept[corner] = point;
    }
  }
  const std::size_t stride = shape.landmarks.size() / kMostLandmarks + 1;
  for (std::size_t i = 0; i < shape.landmarks.size(); ++i) {
    if (i % stride != 0) shape.landmarks[i] = 0;
  }
  return shape;
}

std::vector<char> KeptShape::bytes() const {
  std::vector<char> bytes(kShapeMagic.begin(), kShapeMagic.end());
  const auto add = [&](const auto& value) {
    bytes.resize(bytes.size() + sizeof value);
    std::memcpy(bytes.data() + bytes.size() - sizeof value, &value, sizeof value);
  };
  for_each_number(solid, [&](const double& number) { add(number); });
  add(static_cast<std::uint64_t>(landmarks.size() -
                                 std::count(landmarks.begin(), landmarks.end(), 0U)));
  for (std::uint64_t point = 0; point < landmarks.size(); ++point) {
    if (landmarks[point] == 0) continue;
    add(point);
    add(landmarks[point]);
  }
  const std::vector<char> mesh = packed(coarse);
  bytes.insert(bytes.end(), mesh.begin(), mesh.end());
  return bytes;
}

std::optional<KeptShape> KeptShape::from_bytes(std::span<const char> bytes) {
  bool is_whole = true;
  const auto take = [&](auto& value) {
    is_whole = is_whole && bytes.size() >= sizeof value;
    if (!is_whole) return;
    std::memcpy(&value, bytes.data(), sizeof value);
    bytes = bytes.subspan(sizeof value);
  };
  std::array<char, kShapeMagic.size()> magic{};
  take(magic);
  if (std::string_view(magic.data(), magic.size()) != kShapeMagic) return std::nullopt;
  KeptShape shape;
  bool is_finite = true;
  for_each_number(shape.solid, [&](double& number) {
    take(number);
    is_finite = is_finite && std::isfinite(number);
  });
  std::uint64_t count = 0;
  take(count);
  if (!is_whole || !is_finite || count > bytes.size() / sizeof(Landmark)) return std::nullopt;
  std::vector<Landmark> known(count);
  for (Landmark& landmark : known) take(landmark);
  std::optional<Mesh> coarse = unpacked(bytes);
  if (!coarse || !(shape.solid.frame.scale > 0)) return std::nullopt;
  shape.coarse = std::move(*coarse);
  shape.landmarks.assign(shape.coarse.positions.size(), 0);
  for (const Landmark& landmark : known) {
    if (landmark.point >= shape.landmarks.size()) return std::nullopt;
    shape.landmarks[landmark.point] = landmark.number;
  }
  return shape;
}

}  // namespace triglyph
