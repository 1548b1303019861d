// The header of a PLY file: elements, their properties, and where the payload starts.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/io/readers.h"

namespace triglyph {

struct PlyProperty {
  std::string name;
  bool is_list = false;
  Scalar count = Scalar::UInt8;  // of a list
  Scalar scalar = Scalar::Float32;
};

struct PlyElement {
  std::string name;
  std::uint64_t rows = 0;
  std::vector<PlyProperty> properties;

  // Bytes of a row in a binary file, empty lists counted by their length field alone.
  [[nodiscard]] std::size_t smallest_row() const noexcept;
  [[nodiscard]] bool has_lists() const noexcept;
};

struct PlyHeader {
  FileFormat format = FileFormat::PlyAscii;
  std::vector<PlyElement> elements;
  std::size_t payload = 0;  // first byte behind the line feed that ends end_header
};

// Throws Error Malformed or Unsupported, with the line.
[[nodiscard]] PlyHeader read_ply_header(const Source& source);

}  // namespace triglyph
