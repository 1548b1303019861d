// A mesh together with its connectivity: what schemes and metrics work on.
#pragma once

#include "engine/mesh/halfedges.h"
#include "engine/mesh/mesh.h"

namespace triglyph {

// Views; both must outlive the surface.
struct Surface {
  const Mesh& mesh;
  const Halfedges& halfedges;
};

}  // namespace triglyph
