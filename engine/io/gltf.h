// glTF 2.0, as .gltf (JSON) and .glb (JSON and a binary chunk): what reading keeps for writing, and
// writing. Internal to engine/io, but for images_of_gltf().
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/mesh/mesh.h"

namespace triglyph {

// The parts of a glTF file that change with its positions, besides the positions.
struct GltfFile {
  // A buffer that the JSON holds in base64. Its bytes lie at `place` of the image.
  struct DataUri {
    std::size_t buffer = 0;
    std::uint64_t place = 0;
    std::uint64_t size = 0;
  };
  // An accessor of positions: vertices [first, first + count) of the file.
  struct Accessor {
    std::size_t index = 0;
    std::size_t first = 0;
    std::size_t count = 0;
  };

  bool is_binary = false;
  std::uint64_t json = 0;  // place of the JSON in the file
  std::uint64_t json_size = 0;
  std::vector<DataUri> data_uris;
  std::vector<Accessor> accessors;
};

// A new value of accessors[accessor].min[axis], or of max.
struct BoundsChange {
  std::size_t accessor = 0;
  int axis = 0;
  bool is_max = false;
  double value = 0;
};

struct RewrittenGltf {
  std::vector<char> bytes;
  std::ptrdiff_t shift = 0;  // by which what follows the JSON has moved
};

// Returns the file with new bounds and the data URIs of the image, whose first `file_size` bytes
// are those of the file. Every other byte of the JSON stays; in a GLB, blanks behind the JSON keep
// its chunk a multiple of four bytes, and the lengths of chunk and file follow. A bound that the
// file does not state is not added. Throws Error Malformed where the JSON is not what was read.
// O(bytes).
[[nodiscard]] RewrittenGltf rewritten_gltf(const GltfFile& gltf, std::span<const char> image,
                                           std::size_t file_size,
                                           std::span<const BoundsChange> changes);

// Returns a new file that holds the mesh: one mesh, one node, positions as floats, indices as
// 32-bit integers. Not binary: the buffer is a data URI. O(n).
[[nodiscard]] std::vector<char> export_gltf(const Mesh& mesh, bool is_binary);

// Returns how many bytes the accessors of a .glb take, decoded: what of it is geometry, and not
// pictures. Reads its JSON alone. Nothing for another file, and where it cannot be read. O(bytes of
// the JSON).
[[nodiscard]] std::optional<std::uint64_t> geometry_bytes_of_glb(const std::filesystem::path& path);

// Returns the names of the image files that a .gltf or .glb refers to, percent-decoded; none that
// is a data URI or has a scheme. Throws Error as reading the file does. O(bytes of the JSON).
[[nodiscard]] std::vector<std::string> images_of_gltf(std::span<const char> bytes,
                                                      const std::filesystem::path& path);

}  // namespace triglyph
