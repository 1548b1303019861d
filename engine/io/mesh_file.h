// A mesh file: its bytes, the mesh, and the places of the coordinates in the bytes. Reading never
// allocates memory on the strength of a count that the file claims. Writing copies the input's
// bytes and replaces only the coordinates of points that moved, so materials, comments, order and
// line ends are preserved.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/mesh/mesh.h"

namespace triglyph {

enum class FileFormat { Obj, Off, PlyAscii, PlyLittle, PlyBig, StlAscii, StlBinary, Gltf, Glb };

// Returns the stable name that records use ("ply binary_little_endian").
[[nodiscard]] std::string_view name_of(FileFormat format) noexcept;

// Returns the endings of the files that MeshFile reads, in lower case.
[[nodiscard]] std::span<const std::string_view> mesh_endings() noexcept;

class MeshFile {
 public:
  // Maps the file and reads it in one pass. The extension (one of mesh_endings(), in any case)
  // names the format; ASCII and binary variants are recognised by their structure. Throws Error:
  // Unreadable (does not exist, no permission, not a regular file, empty), Malformed (with line or
  // byte), Unsupported (unknown extension or variant). O(bytes).
  [[nodiscard]] static MeshFile open(const std::filesystem::path& path);

  // Reads a file that is in memory. `name` supplies the extension and appears in messages. Throws
  // as open() does.
  [[nodiscard]] static MeshFile read(std::vector<char> bytes, const std::filesystem::path& name);

  MeshFile(MeshFile&&) noexcept;
  MeshFile& operator=(MeshFile&&) noexcept;
  ~MeshFile();

  [[nodiscard]] FileFormat format() const;
  [[nodiscard]] std::span<const char> bytes() const;

  // Returns why no coordinate of the file can be changed, such as a compressed buffer, with the way
  // out; empty if all can.
  [[nodiscard]] const std::string& why_fixed() const;

  // Returns the number of coordinate triples in the file; in STL, three per face.
  [[nodiscard]] std::size_t vertex_count() const;

  // Returns the number of faces in the file, a polygon counting once.
  [[nodiscard]] std::size_t face_count() const;

  // Returns the mesh. Vertices with equal coordinates (-0 equals 0, no tolerance) are welded into
  // one point, numbered by first appearance; polygons are triangulated independently of the corner
  // they start at; triangles that repeat a point are left out.
  [[nodiscard]] const Mesh& mesh() const;

  // Says whether some face has more than three corners.
  [[nodiscard]] bool has_polygons() const;

  // Returns the triangles of mesh() if its points lay elsewhere: how polygons are cut depends on
  // that. Precondition: as many positions as points. O(corners).
  [[nodiscard]] std::vector<Triangle> triangles_at(std::span<const Vec3> positions) const;

  // Returns the point of every vertex of the file.
  [[nodiscard]] std::span<const std::uint32_t> point_of_vertex() const;

  // Says whether coordinates are decimal numbers in text.
  [[nodiscard]] bool is_decimal() const;

  // Gives coordinates that are moved so many digits more than the file's have; of decimal numbers
  // only. Precondition: count >= 0.
  void set_more_digits(int count);

  // Returns the nearest point that the file's number format can represent. Text files get no more
  // decimals and no more significant digits than they have, so a file of "%.6f" or "%g" stays one,
  // unless set_more_digits() allows it.
  [[nodiscard]] Vec3 round(const Vec3& point) const;

  // Returns the largest distance, in model units along one axis, between neighbouring numbers of
  // the file's format at the magnitudes that occur in it.
  [[nodiscard]] double number_step() const;

  // Returns the bytes of the file with point i moved to positions[i]. A coordinate that rounds to
  // its old value keeps its bytes; every other one reads back as that of round(positions[i]).
  // In glTF, the least and the greatest coordinates that an accessor states change along. Throws
  // Error Unsupported if why_fixed(). Precondition: positions.size() == mesh().positions.size(),
  // all finite. O(bytes). note: the triangulation of polygons depends on positions, so it can
  // differ after reading back.
  [[nodiscard]] std::vector<char> patched(std::span<const Vec3> positions) const;

 private:
  struct Content;
  explicit MeshFile(std::unique_ptr<Content> content);
  std::unique_ptr<Content> content_;
};

}  // namespace triglyph
