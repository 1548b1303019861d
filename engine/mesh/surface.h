// A mesh together with its connectivity, the input of schemes.
#pragma once

#include "engine/mesh/halfedges.h"
#include "engine/mesh/mesh.h"

namespace triglyph {

// Holds references; mesh and halfedges must outlive the surface.
struct Surface {
  const Mesh& mesh;
  const Halfedges& halfedges;
};

}  // namespace triglyph
