// Two meshes beside each other: what the mark moved, how far, and where it is seen most.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/mesh/mesh.h"
#include "render/camera.h"
#include "render/image.h"
#include "render/panels.h"

namespace triglyph {

struct PictureOptions {
  int width = 640;                // of a panel, pixels
  int height = 0;                 // 0: as the mesh is seen
  int samples = 16;               // a pixel
  std::string view = "auto";      // see view_named()
  bool is_flat = false;           // facets shaded flat instead of smooth
  Colour background{1, 1, 1, 1};  // transparent if alpha is 0
};

// "original", "marked", "facets" (those that moved are blue), "points" (likewise), "distance" (of
// each point of the marked mesh from the original surface), "signed" (the same, > 0 outside),
// "worst" (the neighbourhood of the farthest point, before and after, with edges drawn).
[[nodiscard]] std::span<const std::string_view> panel_names();

// Facets with a point that moved. Precondition: the same triangles.
[[nodiscard]] std::vector<bool> moved_facets(const Mesh& original, const Mesh& marked);

// Distance of each point of `marked` from the surface of `original`, model units; with a sign, less
// than zero behind the nearest face.
[[nodiscard]] std::vector<double> distances(const Mesh& original, const Mesh& marked,
                                            bool with_sign);

// One panel for each name, 1 to 6. Meshes with different triangles have no moved facets or points.
// Throws Error Usage for unknown names, too many or none, bad options, or a mesh without faces.
[[nodiscard]] Image draw_comparison(const Mesh& original, const Mesh& marked,
                                    const std::vector<std::string>& panels,
                                    const PictureOptions& options);

// The options with which this mesh can be drawn: the height settled. Throws Error Usage for sizes
// out of range, or if there is nothing to see.
[[nodiscard]] PictureOptions drawable(const Mesh& mesh, PictureOptions options);

// The camera that PictureOptions::view names, for this mesh. Precondition: the height is settled.
[[nodiscard]] Camera camera_for(const Mesh& mesh, const PictureOptions& options);

}  // namespace triglyph
