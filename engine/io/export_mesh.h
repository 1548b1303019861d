// A mesh written as a new file, for samples and conversions; marking patches files instead.
#pragma once

#include <vector>

#include "engine/io/mesh_file.h"
#include "engine/mesh/mesh.h"

namespace triglyph {

struct ExportFormat {
  FileFormat format = FileFormat::Obj;
  bool has_doubles = false;    // PLY: coordinates are declared double, otherwise float
  int significant_digits = 0;  // of text, 1 to 17; 0: the shortest that reads back as the number
};

// The bytes of the file. Shortest text is that of the double, or of the float where PLY declares
// float. Binary STL holds floats; STL leaves out points without a triangle. Normals in STL are
// those of the written positions in double precision.
// Throws Error Unsupported for more triangles than the format can count. O(n), in parallel.
[[nodiscard]] std::vector<char> export_mesh(const Mesh& mesh, const ExportFormat& format);

}  // namespace triglyph
