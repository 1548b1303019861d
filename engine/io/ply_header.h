// The header of a PLY file: the elements, their properties, and the offset of the data.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/io/readers.h"

namespace triglyph {

struct PlyProperty {
  std::string name;
  bool is_list = false;
  Scalar count = Scalar::UInt8;  // type of a list's length
  Scalar scalar = Scalar::Float32;
};

struct PlyElement {
  std::string name;
  std::uint64_t rows = 0;
  std::vector<PlyProperty> properties;

  // Returns the least number of bytes of a row in a binary file: all lists empty.
  [[nodiscard]] std::size_t smallest_row() const noexcept;
  [[nodiscard]] bool has_lists() const noexcept;
};

struct PlyHeader {
  FileFormat format = FileFormat::PlyAscii;
  std::vector<PlyElement> elements;
  std::size_t payload = 0;  // offset of the data, after the line feed of end_header
};

// Parses the header. Throws Error Malformed or Unsupported, with the line.
[[nodiscard]] PlyHeader read_ply_header(const Source& source);

}  // namespace triglyph
