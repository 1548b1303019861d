// Readers of the file formats. Each returns the coordinates, the faces, and the place of every
// coordinate in the file's bytes. Internal to engine/io.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/geometry/vec3.h"
#include "engine/io/mesh_file.h"
#include "engine/mesh/triangulate.h"

namespace triglyph {

struct Source {
  std::span<const char> bytes;
  const std::filesystem::path& path;  // used only in messages
};

// Most vertices, and most corners, of a file: indices have 32 bits, and the last value means
// "none".
inline constexpr std::uint64_t kMaxCount = 0xfffffffe;

enum class Scalar : std::uint8_t { Int8, UInt8, Int16, UInt16, Int32, UInt32, Float32, Float64 };

// Offsets of the three coordinates of a vertex in a text file; y and z are relative to x and may be
// negative.
struct TokenPlace {
  std::uint64_t x;
  std::int32_t y, z;
};

// Coordinates in rows of equal size: vertex v starts at
// base + v / group * group_stride + v % group * stride. A group is a face of a binary STL file.
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
  std::vector<TokenPlace> tokens;  // one per vertex; empty: `rows` applies
  RowPlaces rows;

  // Returns the byte offset of a coordinate.
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

struct GltfFile;

struct FileContent {
  FileFormat format = FileFormat::Obj;
  std::vector<Vec3> vertices;
  Faces faces;
  CoordinatePlaces places;
  // Of a format that keeps coordinates in encoded or in other files: the file's bytes and behind
  // them the decoded ones, which `places` then refers to. Empty: `places` refers to the file.
  std::vector<char> image;
  std::string why_fixed;                 // why no coordinate can be changed; empty: all can
  std::shared_ptr<const GltfFile> gltf;  // of glTF alone
};

// Read one format in one pass. Memory is bounded by a fixed multiple of the file's size, whatever
// counts the file claims. Throw Error Malformed (with line or byte) or Unsupported. O(bytes).
[[nodiscard]] FileContent read_obj(const Source& source);
[[nodiscard]] FileContent read_off(const Source& source);
[[nodiscard]] FileContent read_ply(const Source& source);
[[nodiscard]] FileContent read_stl(const Source& source);
[[nodiscard]] FileContent read_gltf(const Source& source);  // .gltf and .glb

[[nodiscard]] std::size_t size_of(Scalar scalar) noexcept;  // in bytes
[[nodiscard]] bool is_integer(Scalar scalar) noexcept;

// Convert a scalar of a binary file to a double, and back. Storing rounds and saturates integers,
// and replaces a number beyond the range of float by the largest float.
[[nodiscard]] double load(const char* bytes, Scalar scalar, bool is_big_endian) noexcept;
void store(double value, Scalar scalar, bool is_big_endian, char* bytes) noexcept;

// Returns the value that store() keeps of `value`.
[[nodiscard]] double round_to(Scalar scalar, double value) noexcept;

// Returns the distance between neighbouring numbers of the type at the magnitude of `value`.
[[nodiscard]] double step_at(Scalar scalar, double value) noexcept;

}  // namespace triglyph
