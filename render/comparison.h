// Pictures that compare two meshes: what the mark moved, how far, and where it is most visible.
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
  int width = 640;                // of a panel, in pixels
  int height = 0;                 // 0: from the ratio of the mesh as seen
  int samples = 16;               // per pixel
  std::string view = "auto";      // automatic_view(), or see view_named()
  bool is_flat = false;           // flat instead of smooth shading
  Colour background{1, 1, 1, 1};  // transparent if alpha is 0
  std::string original_name;      // in the captions; empty: none
  std::string marked_name;
};

// Returns the names of the panels: "original", "marked", "facets" (those that moved are blue),
// "points" (likewise), "distance" (of each point of the marked mesh from the original surface),
// "signed" (the same, > 0 outside), "worst" (the surroundings of the farthest point, before and
// after, with edges).
[[nodiscard]] std::span<const std::string_view> panel_names();

// Returns for every facet whether one of its points moved. Precondition: the same triangles.
[[nodiscard]] std::vector<bool> moved_facets(const Mesh& original, const Mesh& marked);

// Returns the distance of each point of `marked` from the surface of `original` in model units;
// with a sign, < 0 behind the nearest face. 0 of points that no triangle uses.
[[nodiscard]] std::vector<double> distances(const Mesh& original, const Mesh& marked,
                                            bool with_sign);

// Draws one panel for each name, 1 to 6. If the meshes have different triangles, no facets or
// points count as moved, and the captions say so. Throws Error Usage for unknown names, too many or
// none, bad options, or a mesh without faces.
[[nodiscard]] Image draw_comparison(const Mesh& original, const Mesh& marked,
                                    const std::vector<std::string>& panels,
                                    const PictureOptions& options);

// Returns the options with a height of 0 replaced by the one that suits the mesh. Throws Error
// Usage for sizes out of range, or if there is nothing to draw.
[[nodiscard]] PictureOptions drawable(const Mesh& mesh, PictureOptions options);

// Returns the camera that PictureOptions::view names for this mesh. Precondition: height > 0.
[[nodiscard]] Camera camera_for(const Mesh& mesh, const PictureOptions& options);

}  // namespace triglyph
