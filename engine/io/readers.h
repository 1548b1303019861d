// What the reader of each format hands to MeshFile: the coordinates, the faces, and the place of
// every coordinate in the file's bytes. Internal to engine/io.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "engine/geometry/vec3.h"
#include "engine/io/mesh_file.h"
#include "engine/mesh/triangulate.h"

namespace triglyph {

struct Source {
  std::span<const char> bytes;
  const std::filesystem::path& path;  // for messages alone
};

// Vertices and corners are counted in 32 bits, the last value kept free for "none".
inline constexpr std::uint64_t kMaxCount = 0xfffffffe;

enum class Scalar : std::uint8_t { Int8, UInt8, Int16, UInt16, Int32, UInt32, Float32, Float64 };

// Where the three coordinates of a vertex start: y and z relative to x, before or behind it.
struct TokenPlace {
  std::uint64_t x;
  std::int32_t y, z;
};

// Rows of equal size: vertex v lies at base + v / group * group_stride + v % group * stride.
struct RowPlaces {
  std::uint64_t base = 0;
  std::uint64_t group = 1;
  std::uint64_t group_stride = 0;
  std::uint64_t stride = 0;
  std::array<std::uint64_t, 3> axis = {0, 0, 0};
};

struct CoordinatePlaces {
  bool is_text = true;
  bool is_big_endian = false;
  std::array<Scalar, 3> scalar = {Scalar::Float64, Scalar::Float64, Scalar::Float64};
  std::vector<TokenPlace> tokens;  // one a vertex; empty: `rows` holds
  RowPlaces rows;

  // The byte where the coordinate starts.
  [[nodiscard]] std::uint64_t offset(std::size_t vertex, int axis) const noexcept {
    if (!tokens.empty()) {
      const TokenPlace& place = tokens[vertex];
      return place.x + static_cast<std::uint64_t>(static_cast<std::int64_t>(axis == 0   ? 0
                                                                            : axis == 1 ? place.y
                                                                                        : place.z));
    }
    return rows.base + vertex / rows.group * rows.group_stride + vertex % rows.group * rows.stride +
           rows.axis[axis];
  }
};

struct FileContent {
  FileFormat format = FileFormat::Obj;
  std::vector<Vec3> vertices;
  Faces faces;
  CoordinatePlaces places;
};

// Each throws Error Malformed (with line or byte) or Unsupported; one pass, O(bytes), and never
// more memory than a fixed multiple of the bytes whatever counts the file claims.
[[nodiscard]] FileContent read_obj(const Source& source);
[[nodiscard]] FileContent read_off(const Source& source);
[[nodiscard]] FileContent read_ply(const Source& source);
[[nodiscard]] FileContent read_stl(const Source& source);

// A scalar of a binary file as a double, and back: integers are rounded and saturated, a float
// that is too large becomes the largest one.
[[nodiscard]] std::size_t size_of(Scalar scalar) noexcept;
[[nodiscard]] bool is_integer(Scalar scalar) noexcept;
[[nodiscard]] double load(const char* bytes, Scalar scalar, bool is_big_endian) noexcept;
void store(double value, Scalar scalar, bool is_big_endian, char* bytes) noexcept;
[[nodiscard]] double round_to(Scalar scalar, double value) noexcept;
[[nodiscard]] double step_at(Scalar scalar, double value) noexcept;

}  // namespace triglyph
