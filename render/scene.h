// What is seen in a picture: a surface with colours, dots and balls.
#pragma once

#include <cstdint>
#include <span>
#include <variant>
#include <vector>

#include "engine/mesh/mesh.h"
#include "render/image.h"

namespace triglyph {

// Angle between faces above which an edge is drawn as an edge and not rounded off, degrees.
inline constexpr double kCreaseDegrees = 40;

struct Ball {
  Vec3 centre{0, 0, 0};
  double radius = 0;  // model units
};

struct Scene {
  const Mesh& mesh;                   // must outlive the scene
  std::vector<Vec3> normals;          // one a face (flat) or three (smooth), unit length
  std::vector<Colour> face_colours;   // one a face; empty: clay
  std::vector<Colour> point_colours;  // one a point, linear between; instead of those
  std::vector<Ball> dots;             // solid, in the mark's colour
  std::vector<Ball> balls;            // translucent, green
  double edge_width = 0;              // of drawn edges, model units; 0: none

  // A surface of clay.
  Scene(const Mesh& seen, bool is_flat);
};

[[nodiscard]] std::vector<Vec3> flat_normals(const Mesh& mesh);

// Three a face: the mean of the normals around a corner, by area, of the faces that do not turn
// away from this one by more than the crease angle. O(triangles * valence).
[[nodiscard]] std::vector<Vec3> smooth_normals(const Mesh& mesh);

}  // namespace triglyph
