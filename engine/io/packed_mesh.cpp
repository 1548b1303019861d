#include "engine/io/packed_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>

#include <meshoptimizer.h>

#include "engine/geometry/box.h"

namespace triglyph {
namespace {

// meshoptimizer wants strides of whole words; the fourth number is 0.
using PackedPoint = std::array<std::uint16_t, 4>;

constexpr double kLargestPacked = 65535;

struct PackedHeader {
  std::uint32_t points = 0;
  std::uint32_t triangles = 0;
  std::uint32_t point_bytes = 0;
  std::uint32_t triangle_bytes = 0;
  std::array<double, 3> low{};
  double unit = 0;  // model units
};

// A byte of the codec stands for at most so many points or triangles: a claim of more is wrong, and
// not worth any memory.
constexpr std::uint64_t kMostForAByte = 64;

}  // namespace

std::vector<char> packed(const Mesh& mesh) {
  const Box box = bounding_box(mesh.positions);
  const Vec3 size = box.size();
  PackedHeader header;
  header.points = static_cast<std::uint32_t>(mesh.positions.size());
  header.triangles = static_cast<std::uint32_t>(mesh.triangles.size());
  if (!mesh.positions.empty()) header.unit = std::max({size[0], size[1], size[2]}) / kLargestPacked;
  std::vector<PackedPoint> points;
  for (const Vec3& p : mesh.positions) {
    PackedPoint& point = points.emplace_back();
    point.fill(0);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      header.low.at(axis) = box.low[axis];
      if (!(header.unit > 0)) continue;
      point.at(axis) =
          static_cast<std::uint16_t>(std::lround((p[axis] - box.low[axis]) / header.unit));
    }
  }
  std::vector<unsigned int> corners;
  for (const Triangle& t : mesh.triangles) corners.insert(corners.end(), t.begin(), t.end());
  std::vector<unsigned char> vertices(
      meshopt_encodeVertexBufferBound(points.size(), sizeof(PackedPoint)));
  vertices.resize(meshopt_encodeVertexBuffer(vertices.data(), vertices.size(), points.data(),
                                             points.size(), sizeof(PackedPoint)));
  std::vector<unsigned char> indices(meshopt_encodeIndexBufferBound(corners.size(), points.size()));
  indices.resize(
      meshopt_encodeIndexBuffer(indices.data(), indices.size(), corners.data(), corners.size()));
  header.point_bytes = static_cast<std::uint32_t>(vertices.size());
  header.triangle_bytes = static_cast<std::uint32_t>(indices.size());
  std::vector<char> bytes(sizeof header + vertices.size() + indices.size());
  std::memcpy(bytes.data(), &header, sizeof header);
  std::copy(vertices.begin(), vertices.end(), bytes.begin() + sizeof header);
  std::copy(indices.begin(), indices.end(),
            bytes.begin() + static_cast<std::ptrdiff_t>(sizeof header + vertices.size()));
  return bytes;
}

std::optional<Mesh> unpacked(std::span<const char> bytes) {
  PackedHeader header;
  if (bytes.size() < sizeof header) return std::nullopt;
  std::memcpy(&header, bytes.data(), sizeof header);
  const auto* data = reinterpret_cast<const unsigned char*>(bytes.data()) + sizeof header;
  const std::uint64_t most = kMostForAByte * bytes.size();
  const bool is_sound =
      bytes.size() == sizeof header + std::uint64_t{header.point_bytes} + header.triangle_bytes &&
      header.points <= most && header.triangles <= most && std::isfinite(header.unit) &&
      std::all_of(header.low.begin(), header.low.end(), [](double x) { return std::isfinite(x); });
  if (!is_sound) return std::nullopt;
  std::vector<PackedPoint> points(header.points);
  std::vector<unsigned int> corners(std::size_t{3} * header.triangles);
  if (meshopt_decodeVertexBuffer(points.data(), points.size(), sizeof(PackedPoint), data,
                                 header.point_bytes) != 0 ||
      meshopt_decodeIndexBuffer(corners.data(), corners.size(), data + header.point_bytes,
                                header.triangle_bytes) != 0) {
    return std::nullopt;
  }
  Mesh mesh;
  for (const PackedPoint& point : points) {
    Vec3& p = mesh.positions.emplace_back();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      p[axis] = header.low.at(axis) + header.unit * point.at(axis);
    }
  }
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
    const Triangle t{corners[i], corners[i + 1], corners[i + 2]};
    if (std::max({t[0], t[1], t[2]}) >= points.size()) return std::nullopt;
    mesh.triangles.push_back(t);
  }
  return mesh;
}

}  // namespace triglyph
