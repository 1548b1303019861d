// Export of a mesh as a new file, for samples and conversions. Marking does not use it: it patches
// the input file.
#pragma once

#include <vector>

#include "engine/io/mesh_file.h"
#include "engine/mesh/mesh.h"

namespace triglyph {

struct ExportFormat {
  FileFormat format = FileFormat::Obj;
  bool has_doubles = false;    // PLY: declare coordinates as double instead of float
  int significant_digits = 0;  // text formats: 1 to 17; 0: as few as read back exactly
};

// Returns the bytes of the file. The shortest text is that of the double, or of the float where PLY
// declares float. Binary STL holds floats, STL drops points without a triangle, and its normals are
// computed from the written positions in double precision. Throws Error Unsupported for more
// triangles than the format can count. O(n), parallel.
[[nodiscard]] std::vector<char> export_mesh(const Mesh& mesh, const ExportFormat& format);

}  // namespace triglyph
