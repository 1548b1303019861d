// A mesh file as bytes plus the places of its coordinates. Reading never allocates by a count the
// file merely claims; writing copies the input's bytes and replaces only the coordinates of points
// that moved, so materials, comments, order and line ends stay as they are.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "engine/mesh/mesh.h"

namespace triglyph {

enum class FileFormat { Obj, Off, PlyAscii, PlyLittle, PlyBig, StlAscii, StlBinary };

// Stable name for records ("ply binary_little_endian").
[[nodiscard]] std::string_view name_of(FileFormat format) noexcept;

class MeshFile {
 public:
  // Maps the file and reads it in one pass. The format follows the file name's ending (.obj, .off,
  // .ply, .stl in any case); ascii and binary are told apart by structure.
  // Throws Error: Unreadable (absent, no permission, not a regular file, empty), Malformed (with
  // line or byte), Unsupported (unknown ending or variant). O(bytes).
  [[nodiscard]] static MeshFile open(const std::filesystem::path& path);

  // The same for bytes in memory: `name` gives the ending and stands in messages.
  [[nodiscard]] static MeshFile read(std::vector<char> bytes, const std::filesystem::path& name);

  MeshFile(MeshFile&&) noexcept;
  MeshFile& operator=(MeshFile&&) noexcept;
  ~MeshFile();

  [[nodiscard]] FileFormat format() const;
  [[nodiscard]] std::span<const char> bytes() const;
  [[nodiscard]] std::size_t vertex_count() const;  // coordinate triples in the file (STL: corners)
  [[nodiscard]] std::size_t face_count() const;    // faces as the file counts them, polygons as one

  // Points welded by equal coordinates (-0 equals 0, no tolerance), numbered by first appearance;
  // polygons cut into triangles the same way whatever corner they start at; triangles that repeat
  // a point are left out.
  [[nodiscard]] const Mesh& mesh() const;

  // The point of every coordinate triple in the file.
  [[nodiscard]] std::span<const std::uint32_t> point_of_vertex() const;

  // The nearest point the file's own number format can hold. Text files get no more decimals and
  // no more significant digits than they have, so a file of "%.6f" or "%g" stays one.
  [[nodiscard]] Vec3 round(const Vec3& point) const;

  // The largest distance, along one axis, between neighbouring numbers of the file's format at the
  // magnitudes that occur in it; model units.
  [[nodiscard]] double number_step() const;

  // The file with point i at positions[i]. A coordinate that is where it was, or that rounds to
  // where it was, keeps its bytes; every other one reads back as round(positions[i]).
  // note: polygons are cut by their positions, so the triangles read back can be cut another way.
  // Precondition: positions.size() == mesh().positions.size(), all finite.
  [[nodiscard]] std::vector<char> patched(std::span<const Vec3> positions) const;

 private:
  struct Content;
  explicit MeshFile(std::unique_ptr<Content> content);
  std::unique_ptr<Content> content_;
};

}  // namespace triglyph
