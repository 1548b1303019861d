// The two compressions of glTF, decoded by the libraries that define them. Internal to engine/io.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "engine/geometry/vec3.h"
#include "engine/mesh/triangulate.h"

namespace triglyph {

// How EXT_meshopt_compression packs a buffer view.
struct MeshoptView {
  std::uint64_t count = 0;
  std::uint64_t stride = 0;
  std::string_view mode;    // ATTRIBUTES, TRIANGLES or INDICES
  std::string_view filter;  // NONE, OCTAHEDRAL, QUATERNION or EXPONENTIAL; empty as NONE
};

// Appends the decoded view to `out`. Returns false, with `out` unchanged, if the bytes are not such
// a view, or fewer than could hold as many values. O(decoded bytes).
[[nodiscard]] bool decode_meshopt(const MeshoptView& view, std::span<const char> bytes,
                                  std::vector<char>& out);

struct DracoMesh {
  std::vector<Vec3> points;
  std::vector<Triangle> triangles;
};

// Decodes the mesh of KHR_draco_mesh_compression; `position` is the attribute's id. Returns false
// if the bytes are no such mesh. Memory is bounded by what the library takes for it. O(decoded
// bytes).
[[nodiscard]] bool decode_draco(std::span<const char> bytes, std::uint64_t position,
                                DracoMesh& out);

}  // namespace triglyph
