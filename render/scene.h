// The contents of a picture: a coloured surface, dots and balls.
#pragma once

#include <cstdint>
#include <span>
#include <variant>
#include <vector>

#include "engine/mesh/mesh.h"
#include "render/image.h"

namespace triglyph {

// Smooth shading keeps edges whose faces differ by more than this angle, in degrees.
inline constexpr double kCreaseDegrees = 40;

struct Ball {
  Vec3 centre{0, 0, 0};
  double radius = 0;  // model units
};

struct Scene {
  const Mesh& mesh;                   // must outlive the scene
  std::vector<Vec3> normals;          // one per face (flat) or three (smooth), unit length
  std::vector<Colour> face_colours;   // one per face; empty: clay
  std::vector<Colour> point_colours;  // one per point, interpolated; replaces face_colours
  std::vector<Ball> dots;             // opaque, in the mark's colour
  std::vector<Ball> balls;            // translucent, green
  double edge_width = 0;              // of drawn edges, model units; 0: none

  // Starts with a clay surface and nothing else.
  Scene(const Mesh& seen, bool is_flat);
};

// Returns the unit normals of the faces. O(triangles).
[[nodiscard]] std::vector<Vec3> flat_normals(const Mesh& mesh);

// Returns three unit normals per face: for each corner the mean, weighted by area, of the normals
// of the faces around it that differ from this face's by at most the crease angle. O(triangles *
// valence).
[[nodiscard]] std::vector<Vec3> smooth_normals(const Mesh& mesh);

}  // namespace triglyph
